"""What is real of a machine: drives and terminals of a bus on the rows of a card."""
