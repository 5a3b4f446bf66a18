"""One motion profile: segments of constant jerk along the path of a master or of a jog."""
