"""What an interpreter keeps and asks: modal state, parameters, cells of the store, the machine."""
