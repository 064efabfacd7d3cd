"""Adapters: the planner inside other systems."""
