"""Drive Talk: the card asks and configures drives over a serial line, or passes a terminal on."""
