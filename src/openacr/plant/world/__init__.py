"""The world as it runs: attached devices, faults, and what a viewer sees of it."""
