"""What followers and masters take their pulses and their time from."""
