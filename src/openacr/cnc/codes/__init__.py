"""The codes of both dialects, one decorated function each, and the order in which they act."""
