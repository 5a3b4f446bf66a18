"""The RS-274 side: part programs read, checked and turned into canonical moves."""
