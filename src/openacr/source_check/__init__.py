"""Controller files read as a card would read them, without a card: every line, every error."""
