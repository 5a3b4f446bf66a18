"""Motion commanded by an operator: jog, hand wheel, homing, probing, teaching."""
