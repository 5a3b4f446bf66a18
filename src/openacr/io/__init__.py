"""Sockets, serial ports and the wall clock: thin shells around the card."""
