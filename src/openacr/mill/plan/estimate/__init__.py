"""Run times, setpoints and checks of a program without a card."""
