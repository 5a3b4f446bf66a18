"""AcroBASIC: the language of the card, from the text of a line to its effect."""
