"""An MTConnect agent: probe, current, sample and assets over HTTP."""
