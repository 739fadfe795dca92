"""To and from the formats of simulators, planners and design offices."""
