"""Words, grammar and rows of the language: text to tree and back."""
