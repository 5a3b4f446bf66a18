"""Servo tuning: the motor of an axis identified, its loop predicted, gains proposed."""
