"""Values of a machine for the systems around it, all fed by one table."""
