"""Worlds to drive in, behind one protocol: the built-in one, SUMO, and recorded traffic."""
