"""Commands that talk to a card, virtual or real, over its link."""
