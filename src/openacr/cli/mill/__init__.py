"""`openacr mill ...`: part programs checked, drawn, timed and run; the machine by hand."""
