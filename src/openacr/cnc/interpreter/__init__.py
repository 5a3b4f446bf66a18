"""A loaded program to canonical entries: run, checked, replayed, or block by block."""
