"""The bytes of EtherCAT: frames, registers, mailboxes, device descriptions (ETG.1000, ETG.2010)."""
