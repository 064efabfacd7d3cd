"""Two states of the law compared by field: sides -> aligned items -> changes with their impact -> text or JSON."""
