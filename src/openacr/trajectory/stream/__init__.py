"""From segments to setpoints: chains, corners, and the planner that joins their courses."""
