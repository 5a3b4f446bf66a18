"""The master of an EtherCAT segment: scan, SDO, states, the cyclic frame."""
