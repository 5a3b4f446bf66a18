"""`openacr mill ...`: check, draw, time and run part programs; operate the machine by hand."""
