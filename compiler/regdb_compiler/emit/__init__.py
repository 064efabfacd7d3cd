"""Rows -> files: the database first, then what is read back from it (CSV, JSON, Parquet), then the manifest that lists them."""
