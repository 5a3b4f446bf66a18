"""The CANopen master of the card: it finds nodes, exchanges data with them, watches them."""
