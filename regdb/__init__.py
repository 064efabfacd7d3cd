"""The language both sides speak: truth, units, vocabulary, states, condition tree, regulation row, schema."""
