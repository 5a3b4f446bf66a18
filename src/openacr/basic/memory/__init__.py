"""What a card keeps: programs, variables, aliases, set-ups, and what ESAVE stores."""
