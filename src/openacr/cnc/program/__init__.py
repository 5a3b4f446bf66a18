"""A loaded program: its texts, its labels, and which line comes next."""
