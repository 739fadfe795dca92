"""The accuracy of a result.

In: a result and a reference. Out: precision, recall, deviations and miscoding by the published protocols, and layers with
the outcome of every object.
"""
