"""CANopen on a real bus: frames, objects of a node, I/O nodes of the profile CiA 401."""
