"""Devices on networks: CANopen nodes and their terminals, Aries drives on serial lines."""
