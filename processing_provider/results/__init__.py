"""What happens to results once they are made: the group they go into, their place among the layers, where they come from."""
