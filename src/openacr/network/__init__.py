"""The networks of the card: CANopen expansion I/O, and Drive Talk to its drives."""
