"""`openacr verify`: the part programs of a shop against its machine."""
