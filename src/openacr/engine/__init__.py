"""The compiled loop: world, servo interrupt and background, tick after tick."""
