"""All part programs of a folder checked against one machine."""
