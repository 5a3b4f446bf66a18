"""How hosts talk to the card: text lines and binary packets, sans I/O and without a clock."""
