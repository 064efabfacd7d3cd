"""Database and scene in, decision out."""
