"""What libyaml says when it gives up, said again for the author: the place, the likely mistake, the way out."""

import re

from regdb_compiler.diagnostics import Diagnostic, Place
from regdb_compiler.tree import Lines

COLON = "mapping values are not allowed"
UNCLOSED = ("found unexpected end of stream", "found unexpected document indicator")
TOLD: tuple[tuple[str, str, str], ...] = (
    ("could not find expected ':'", "this line is neither `key: value` nor a list item",
     "write `key: value`, or indent the line so that it continues the text above"),
    ("did not find expected '-' indicator", "this line is level with a list but is not an item of it",
     "begin it with `- `, or indent it to belong to the item above or to the mapping outside"),
    ("did not find expected ',' or ']'", "this list in brackets is not closed where it should be",
     "separate its items by commas and close it with `]`"),
    ("did not find expected ',' or '}'", "this mapping in braces is not closed where it should be",
     "separate its entries by commas and close it with `}`"),
    ("unknown escape character", "this escape is unknown inside double quotes",
     "write `\\\\` for a backslash, or use single quotes"),
    ("did not find expected comment or line break", "only a line break may follow `|` or `>`",
     "put the text on the next line, indented, or quote it"),
    ("did not find expected node content", "no value can begin with this character",
     "put the value in quotes, or remove the bracket, brace or comma"),
    ("did not find expected alphabetic or numeric", "`&` and `*` begin an anchor or an alias, which have no name here",
     "put the value in quotes"),
    ("block sequence entries are not allowed", "a list item cannot begin on the line of its key",
     "put `- ` on the next line, or write the list in brackets: `[a, b]`"),
    ("found undefined tag handle", "`!` begins a YAML tag, and tags are not used here", "put the value in quotes"),
    ("expected <document start>", "text follows the end of the document", "remove the `...` line, or what follows it"),
    ("directive", "`%` at the beginning of a line is a YAML directive, and none is used here",
     "remove the line, or indent or quote the text"),
    ("incompatible YAML document", "this asks for another version of YAML", "remove the `%YAML` line"),
    ("tab character that violates indentation", "this line is indented with a tab", "indent with spaces"),
    ("tab character where an indentation space", "this line is indented with a tab", "indent with spaces"),
    ("anchor", "`&` begins an anchor, and anchors are not used here", "put the value in quotes"),
    ("alias", "`*` begins an alias, and aliases are not used here", "put the value in quotes"),
    ("tag", "`!` begins a YAML tag, and tags are not used here", "put the value in quotes"),
)  # fmt: skip


def syntax_error(lines: Lines, problem: str, at: int, context: str, context_at: int | None) -> Diagnostic:
    """The diagnostic for a problem that libyaml found at offset `at` while it was busy with `context`."""
    if problem in UNCLOSED and context_at is not None:
        return _unclosed_quote(lines, context_at)
    at = min(at, _last_word(lines.text))
    if "could not find expected ':'" in problem and context_at is not None:
        at = context_at
    message, advice = _explain(lines, problem, at)
    return Diagnostic(
        "R001", "yaml-syntax", "error", message, _place(lines, problem, at),
        note=_expectation(problem), help=advice, related=_related(lines, context, context_at, at),
    )  # fmt: skip


def _unclosed_quote(lines: Lines, opened: int) -> Diagnostic:
    """The mistake is where the quote opens, not at the end of the file, where libyaml notices it."""
    return Diagnostic(
        "R001", "yaml-syntax", "error", "this quote is never closed", lines.place(opened, opened + 1),
        help="close the quote; inside single quotes write `''` for an apostrophe, inside double quotes `\\\"`",
    )  # fmt: skip


def _explain(lines: Lines, problem: str, at: int) -> tuple[str, str]:
    """Our message and advice for one of libyaml's problems."""
    if COLON in problem:
        return _explain_colon(lines, at)
    if "did not find expected key" in problem:
        return _explain_key(lines, at)
    if "cannot start any token" in problem:
        return _explain_character(lines.text[at : at + 1])
    for known, message, advice in TOLD:
        if known in problem:
            return message, advice
    return f"this is not YAML: {problem}", "check the quotes and the indentation"


def _explain_colon(lines: Lines, at: int) -> tuple[str, str]:
    """A colon where no key can be: a second one on its line, or a line deeper than a finished value."""
    if re.search(r":\s", _before(lines, at)):
        return "a colon followed by a space stands in text without quotes", "put the whole text in quotes"
    return (
        "this key stands where no key can be: the line above already has its value",
        "indent it like the keys it belongs to, or quote the text if the colon is part of it; a key needs `: `",
    )


def _explain_key(lines: Lines, at: int) -> tuple[str, str]:
    """No key where one must be: words after a closing quote, a list item among keys, or an odd indentation."""
    if _before(lines, at).strip():
        return (
            "text follows a value that has ended",
            "put all of it inside the quotes; inside single quotes write `''` for an apostrophe",
        )
    if lines.text.startswith("- ", at):
        return "a list item stands among keys", "indent it under the key that it belongs to, on a line below the key"
    return (
        "the indentation of this line matches no key above it",
        "line it up with the keys it belongs to; text of a block must all be indented at least like its first line",
    )


def _explain_character(char: str) -> tuple[str, str]:
    if char == "\t":
        return "this line is indented with a tab", "indent with spaces"
    return f'a value without quotes cannot begin with "{char}"', "put the value in quotes"


def _before(lines: Lines, at: int) -> str:
    """What stands on the line before an offset."""
    return lines.text[lines.starts[lines.line(at) - 1] : at]


def _expectation(problem: str) -> str:
    found = re.search(r"expected ('[^']*'(?: or '[^']*')?)", problem)
    return f"expected {found[1]}" if found else ""


def _related(lines: Lines, context: str, context_at: int | None, at: int) -> tuple[tuple[Place, str], ...]:
    """Where that began which libyaml could not finish, if it began on an earlier line."""
    if context_at is None or lines.line(context_at) >= lines.line(at):
        return ()
    thing = {
        "while parsing a flow sequence": "the list in brackets begins here",
        "while parsing a flow mapping": "the mapping in braces begins here",
        "while parsing a block collection": "the list begins here",
        "while parsing a block mapping": "the mapping begins here",
    }.get(context)
    return ((_word_place(lines, context_at), thing),) if thing else ()


def _place(lines: Lines, problem: str, at: int) -> Place:
    """The word at fault; of a key that is out of place, the key and not its colon."""
    before = _before(lines, at)
    if COLON in problem and not re.search(r":\s", before) and before.strip():
        return lines.place(at - len(before.lstrip()), at)
    return _word_place(lines, at)


def _last_word(text: str) -> int:
    """Offset of the last character that is not white space; the end of a file is no place to point at."""
    return max(len(text.rstrip()) - 1, 0)


def _word_place(lines: Lines, at: int) -> Place:
    """The word at an offset, or one character."""
    found = re.compile(r"[\w.-]+").match(lines.text, at)
    return lines.place(at, found.end() if found else min(at + 1, len(lines.text)))
