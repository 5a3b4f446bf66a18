"""What is known of a card and commanded to it: inputs, outputs, set-up, alarms, ownership."""
