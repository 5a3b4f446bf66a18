"""The time law of a smooth chain: the fastest speed within every limit."""
