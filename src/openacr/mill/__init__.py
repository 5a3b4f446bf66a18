"""The machine tool: part programs run on a card, virtual or real, through its host interface."""
