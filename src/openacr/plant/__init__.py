"""What is outside the card: motors, encoders, switches and wiring, as `machine.toml` says."""
