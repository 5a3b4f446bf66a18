"""An edge node of Sparkplug B over MQTT."""
