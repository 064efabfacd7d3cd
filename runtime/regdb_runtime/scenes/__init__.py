"""Scenes: the facts of law for each piece of a path, from map, tracks, lights, clock and history."""
