"""Strategy: which states may follow, and what each would do here."""
