"""A set of words written as one text, as the word lists of the matcher are."""


def word_set(text: str) -> frozenset[str]:
    """The words between the spaces."""
    return frozenset(text.split())
