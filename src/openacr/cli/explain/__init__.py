"""Look-ups: parameters, flags, packets and addresses explained."""
