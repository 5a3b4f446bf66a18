"""The SYSVAR store: system parameters, offsets and variables that outlive every run."""
