"""The simulated machine around the card: motors, encoders, switches, wiring (`machine.toml`)."""
