"""Citations parsed, printed and sorted: `CVC 21453(b)`, `LAMC 80.14`, `UVC 11-202`."""

import re
from dataclasses import dataclass
from functools import total_ordering

_CITATION = re.compile(
    r"\s*(?P<code>[A-Za-z][A-Za-z. ]*?)\s*(?:§+|sec(?:tion)?\.?)?\s*"
    r"(?P<section>\d[\d.\-]*\d|\d)(?P<subdivision>(?:\s*\([A-Za-z0-9]+\))*)\s*\Z",
    re.IGNORECASE,
)
_LONG = {"cal. veh. code": "CVC", "california vehicle code": "CVC", "vehicle code": "CVC", "l.a. mun. code": "LAMC",
         "l.a. county code": "LACC", "uniform vehicle code": "UVC"}  # fmt: skip


class CitationError(ValueError):
    """Text that is no citation."""


@total_ordering
@dataclass(frozen=True, slots=True)
class Citation:
    """A place in a code: its short name, the section's number and the subdivision with its parentheses (may be empty)."""

    code: str
    section: str
    subdivision: str = ""

    def __str__(self) -> str:
        return f"{self.code} {self.section}{self.subdivision}"

    @property
    def parts(self) -> tuple[str, ...]:
        """The subdivision's levels: ("b", "1") for (b)(1)."""
        return tuple(re.findall(r"\(([^)]*)\)", self.subdivision))

    def contains(self, other: "Citation") -> bool:
        """Whether `other` is this place or lies within it."""
        return (self.code, self.section) == (other.code, other.section) and other.parts[: len(self.parts)] == self.parts

    def __lt__(self, other: "Citation") -> bool:
        return self.sort_key < other.sort_key

    @property
    def sort_key(self) -> tuple[str, tuple[tuple[int, int, str], ...], tuple[tuple[int, int, str], ...], str]:
        """What citations are sorted by. The text comes last, so that 15.20.010 and 15.20.10 have an order too."""
        return self.code, section_key(self.section), tuple(_part_key(part) for part in self.parts), str(self)


def _part_key(part: str) -> tuple[int, int, str]:
    return (0, int(part), "") if part.isdigit() else (1, len(part), part)


def section_key(section: str) -> tuple[tuple[int, int, str], ...]:
    """Order of section numbers as codes print them: 22349 before 22349.5 before 22350, 11-202 before 11-1003."""
    return tuple(_part_key(part) for part in re.split(r"[.\-]", section))


def parse_citation(text: str) -> Citation:
    """Read a citation in short or long form. Raises CitationError."""
    match = _CITATION.match(text)
    if match is None:
        raise CitationError(f"{text!r} is no citation; write it as CVC 21453(b), LAMC 80.14 or UVC 11-202")
    code = " ".join(match["code"].split())
    code = _LONG.get(code.lower(), code)
    return Citation(code, match["section"], re.sub(r"\s+", "", match["subdivision"]))
