"""The road surface: its points, its outline, and what stands on it."""
