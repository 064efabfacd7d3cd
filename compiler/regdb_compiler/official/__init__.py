"""Official text that a user keeps beside the codes: read from pages and files, kept outside git, compared with the annotation."""
