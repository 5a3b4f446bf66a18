"""Part programs as the target of the debugger."""
