"""How fast this machine runs a card: `make bench`, or `python -m bench [NAME]...`."""
