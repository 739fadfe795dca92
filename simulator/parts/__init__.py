"""What all simulated scenes share: scanners and vehicle, objects, paint, strips beside the road, materials, and the fields of the truth."""
