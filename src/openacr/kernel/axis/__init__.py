"""One axis: its inputs, its setpoint, its servo loop and its drive."""
