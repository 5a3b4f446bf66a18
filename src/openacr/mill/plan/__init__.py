"""Planning of part programs without a card: geometry, speeds, limits, times, pictures."""
