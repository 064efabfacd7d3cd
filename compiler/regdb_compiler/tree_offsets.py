"""Which character of the file each character of a scalar's text comes from, through quotes, escapes and folding."""

ESCAPE_LENGTHS = {"x": 4, "u": 6, "U": 10}
BREAKS = "\r\n\x85\u2028\u2029"
BLANKS = " \t" + BREAKS


def raw_offsets(text: str, raw: str, *, plain: bool) -> list[int] | None:
    """For each character of `text`, and its end, the offset in `raw` (as written, with quotes or block header).

    None if the two do not line up, which a caller answers with the place of the whole scalar.
    """
    if plain and len(text) == len(raw):
        return list(range(len(text) + 1))
    quote = raw[0] if not plain and raw[:1] in ("'", '"') else ""
    at = 1 if quote else 0 if plain else _after_header(raw)
    offsets: list[int] = []
    for char in text:
        found = _find(char, raw, at, quote)
        if found is None:
            return None
        offsets.append(found[0])
        at = found[1]
    return [*offsets, offsets[-1] + 1 if offsets else at]


def _after_header(raw: str) -> int:
    """A block's words begin after the line that holds `|` or `>`."""
    return raw.find("\n") + 1


def _find(char: str, raw: str, at: int, quote: str) -> tuple[int, int] | None:
    """Where `char` is written at or after `at`, and where to go on."""
    if char in BLANKS:
        return _find_blank(char, raw, at, quote)
    at = _skip_blanks(raw, at, quote)
    if at >= len(raw):
        return None
    if quote == '"' and raw[at] == "\\":
        return at, at + ESCAPE_LENGTHS.get(raw[at + 1 : at + 2], 2)
    if raw[at] != char:
        return None
    return at, at + (2 if quote == "'" and char == "'" else 1)


def _find_blank(char: str, raw: str, at: int, quote: str) -> tuple[int, int] | None:
    """A space or break in the text is itself, an escape, or a fold: a run of blanks with a break in it."""
    if quote == '"' and raw[at : at + 1] == "\\" and raw[at + 1 : at + 2] not in BREAKS:
        return at, at + ESCAPE_LENGTHS.get(raw[at + 1], 2)
    if at >= len(raw):
        return (len(raw), len(raw)) if char in BREAKS else None
    fold = at
    while fold < len(raw) and raw[fold] in " \t":
        fold += 1
    if fold < len(raw) and raw[fold] in BREAKS and (char in BREAKS or _text_follows(raw, fold, quote)):
        return fold, fold + (2 if raw.startswith("\r\n", fold) else 1)
    if raw[at] == char:
        return at, at + 1
    return (fold, fold) if char in BREAKS and fold == len(raw) else None


def _text_follows(raw: str, fold: int, quote: str) -> bool:
    """Whether the break at `fold` folds to a space: words come after it."""
    rest = raw[fold:].lstrip(BLANKS)
    return bool(rest) and rest != quote


def _skip_blanks(raw: str, at: int, quote: str) -> int:
    """Past indentation, folded breaks and, in double quotes, escaped line ends."""
    while at < len(raw):
        if raw[at] in BLANKS:
            at += 1
        elif quote == '"' and raw[at] == "\\" and raw[at + 1 : at + 2] in ("\n", "\r"):
            at += 2
        else:
            break
    return at
