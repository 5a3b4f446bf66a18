"""Machine tool: runs part programs on a virtual or real card through its host interface."""
