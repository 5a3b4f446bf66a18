"""The command channels of a card: typed lines, levels, devices of programs."""
