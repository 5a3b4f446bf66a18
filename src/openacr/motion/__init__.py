"""The slow side of motion: what commands, packets and operators may ask of the card."""
