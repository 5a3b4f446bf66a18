"""What the card watches and shows: limits, flags, samples."""
