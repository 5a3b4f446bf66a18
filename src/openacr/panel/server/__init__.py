"""HTTP and the WebSocket of the panel."""
