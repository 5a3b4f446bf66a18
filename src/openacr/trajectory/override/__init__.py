"""Override and feed hold: the time scale of a planned trajectory."""
