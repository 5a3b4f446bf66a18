"""Machine configuration read from the store: axes, wiring, speeds, formats, languages."""
