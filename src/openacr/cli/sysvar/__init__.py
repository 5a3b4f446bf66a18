"""`openacr sysvar ...`: read and change the SYSVAR store."""
