"""An emulated segment: slaves, terminals and drives, for a master to work with."""
