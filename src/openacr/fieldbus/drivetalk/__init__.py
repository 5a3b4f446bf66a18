"""Drive Talk to Aries drives on serial lines of the computer."""
