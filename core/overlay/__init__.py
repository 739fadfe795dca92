"""UAV images: ground control points, polynomial georeferencing."""
