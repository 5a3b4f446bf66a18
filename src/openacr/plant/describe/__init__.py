"""`machine.toml`: its schema, how it is read, and what is checked in it."""
