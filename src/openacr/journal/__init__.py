"""Journal files: entries with ticks, read and written for virtual cards and recorded sessions."""
