"""What engineers use: scope, tuning, terminals, watches, programs of the card, the world."""
