"""What follows a source or a setpoint: gears, cams, offsets, objects."""
