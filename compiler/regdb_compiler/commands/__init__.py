"""The author's commands; only these modules print or exit."""
