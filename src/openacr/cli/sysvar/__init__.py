"""`openacr sysvar ...`: the SYSVAR store read and changed."""
