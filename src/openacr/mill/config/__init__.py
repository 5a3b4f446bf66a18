"""What the store says about the machine: axes, wiring, speeds, formats, languages."""
