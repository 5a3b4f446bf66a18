"""EtherCAT: what is on the wire, and devices that are emulated."""
