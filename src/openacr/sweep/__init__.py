"""Parameter studies: many runs of a project with other values, their measures in one table."""
