"""YAML in, diagnostics and a database out."""
