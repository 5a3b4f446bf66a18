"""One block: made ready, its statement, its loops and its compensation."""
