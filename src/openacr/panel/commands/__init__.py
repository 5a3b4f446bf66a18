"""What operators can do, by name: one function for each command."""
