"""What follows a source: gears, cams, hand wheels, objects."""
