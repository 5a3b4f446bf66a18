"""PLC programs: relay ladder as text, compiled once, scanned inside the servo interrupt."""
