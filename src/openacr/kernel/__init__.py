"""The servo tick: everything the card does in one servo period."""
