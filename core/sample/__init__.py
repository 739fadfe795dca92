"""A simulated survey with known truth, for the demo, the tests and for trying settings."""
