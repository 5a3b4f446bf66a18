"""What editors ask of controller files and part programs, without a protocol: `Engine`."""
