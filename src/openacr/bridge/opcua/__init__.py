"""An OPC UA server with the browse names of the companion specifications for machine tools."""
