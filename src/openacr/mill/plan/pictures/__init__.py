"""What a program draws: its tool path, its motion, and the material it leaves."""
