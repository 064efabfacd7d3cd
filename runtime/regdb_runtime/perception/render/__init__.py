"""Rendered camera frames of a world, with the truth about everything drawn: a front camera's view for tests, demos and the live page."""
