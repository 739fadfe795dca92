"""The road map on paper."""
