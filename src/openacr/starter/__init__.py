"""First projects: a machine, its programs, a scenario and a test from a few choices."""
