"""What only the rs274ngc dialect has: its codes, parameters and O-words."""
