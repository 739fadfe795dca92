"""What all simulated scenes share: scanners and vehicle, objects, paint, strips beside the road, materials, and the fields of the truth.

In: a scene, as `SurveyedScene` describes it. Out: `Hits` of the rays of its scanners, and its `Truth`.
"""
