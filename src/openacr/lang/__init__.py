"""What BASIC and the other text languages share: source positions and tokens."""
