"""AcroBASIC and PLC programs in an editor."""
