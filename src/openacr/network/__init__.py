"""The networks of the card: CANopen expansion I/O."""
