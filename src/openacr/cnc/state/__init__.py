"""State of an interpreter: modal state, parameters, cells of the store, the machine."""
