"""Access to a card from the machine side: inputs, outputs, set-up, alarms, ownership."""
