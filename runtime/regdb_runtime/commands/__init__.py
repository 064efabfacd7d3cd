"""The vehicle's commands: thin shells over the runtime; only they print and exit."""
