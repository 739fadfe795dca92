"""How good it is: results against a reference."""
