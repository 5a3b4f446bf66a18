"""Byte code: what compiles it, what runs it, and what handlers of commands work with."""
