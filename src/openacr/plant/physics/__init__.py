"""One servo period of the machine: motors, drives, friction, switches and wiring."""
