"""Programs loaded: every line read once, all errors found, the dialect recognised."""
