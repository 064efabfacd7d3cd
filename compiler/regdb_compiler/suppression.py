"""Findings that a comment allows, and the comments that allow nothing or give no reason."""

from collections.abc import Iterable
from dataclasses import dataclass

from regdb_compiler.diagnostics import Diagnostic, Edit, Fix, Place, RuleText, in_order
from regdb_compiler.source import SourceFile, Suppression

SUPPRESSION_RULES: tuple[RuleText, ...] = (
    ("R901", "suppression-without-reason", "A comment allows a finding without saying why, and so allows nothing."),
    ("R902", "unused-suppression", "A comment allows a finding that is not there."),
    ("R904", "unreadable-suppression", "A comment begins with `regdb:` but is not of a form that means anything."),
)
FORM = "write `# regdb: allow <rule>[, <rule>] -- <reason>`, or `allow-file` for the whole file"


@dataclass(frozen=True, slots=True)
class Sifted:
    """What is to be reported, and what a comment allowed, with its reason."""

    kept: tuple[Diagnostic, ...]
    suppressed: tuple[tuple[Diagnostic, str], ...]


def apply(diagnostics: Iterable[Diagnostic], files: Iterable[SourceFile], *, report_unused: bool = True) -> tuple[Diagnostic, ...]:
    """The findings that no comment allows, with those about the comments themselves, in order."""
    return sift(diagnostics, files, report_unused=report_unused).kept


def sift(diagnostics: Iterable[Diagnostic], files: Iterable[SourceFile], *, report_unused: bool = True) -> Sifted:
    """As `apply`, and what was suppressed besides. Unused comments count only if all rules have run."""
    files = tuple(files)
    comments = {file.path: file.comments for file in files}
    used: set[tuple[Suppression, str]] = set()
    kept: list[Diagnostic] = []
    suppressed: list[tuple[Diagnostic, str]] = []
    for finding in diagnostics:
        allowing = _allowing(finding, comments.get(finding.place.path, ()))
        used.update(allowing)
        if allowing:
            suppressed.append((finding, allowing[0][0].reason))
        else:
            kept.append(finding)
    for file in files:
        if file.root is None:
            continue  # what is a comment and what is text is not certain there
        kept.extend(_about_comments(file, used, report_unused=report_unused))
    return Sifted(in_order(kept), tuple(suppressed))


def can_be_allowed(diagnostic: Diagnostic) -> bool:
    """A file that cannot be read, and a comment about comments, are not for a comment to allow."""
    return not (diagnostic.code.startswith("R0") and diagnostic.level == "error") and diagnostic.code not in {
        code for code, _, _ in SUPPRESSION_RULES
    }


def _allowing(finding: Diagnostic, comments: tuple[Suppression, ...]) -> list[tuple[Suppression, str]]:
    """The comments with a reason that allow a finding, each with the rule as it is written there."""
    if not comments or not can_be_allowed(finding):
        return []
    names = {finding.code.lower(), finding.name.lower()}
    return [
        (comment, rule)
        for comment in comments
        if comment.reason and comment.first_line <= finding.place.line <= comment.last_line
        for rule in comment.rules
        if rule.lower() in names
    ]


def _about_comments(file: SourceFile, used: set[tuple[Suppression, str]], *, report_unused: bool) -> Iterable[Diagnostic]:
    for comment in file.comments:
        if not comment.rules:
            yield _finding("R904", comment.place, "this comment is not understood", FORM)
        elif not comment.reason:
            message = f"no reason is given for allowing {_listed(comment.rules)}, so it is not allowed"
            yield _finding("R901", comment.place, message, "end the comment with ` -- ` and the reason")
        elif report_unused:
            unused = tuple(rule for rule in comment.rules if (comment, rule) not in used)
            if unused:
                yield _unused(file, comment, unused)


def _unused(file: SourceFile, comment: Suppression, unused: tuple[str, ...]) -> Diagnostic:
    left = tuple(rule for rule in comment.rules if rule not in unused)
    edit = _shorten(file, comment, left) if left else _delete(file, comment.place)
    title = f"no longer allow {_listed(unused)}" if left else "delete the comment"
    message = f"nothing is found here that {_listed(unused)} would allow"
    return _finding("R902", comment.place, message, title, Fix("safe", title, (edit,)))


def _shorten(file: SourceFile, comment: Suppression, rules: tuple[str, ...]) -> Edit:
    """The same comment with the rules that are still needed."""
    line = file.text.split("\n")[comment.place.line - 1]
    words = line[comment.place.column - 1 : comment.place.end_column - 1]
    head, reason = words.split("--", 1)
    verb = "allow-file" if "allow-file" in head.split() else "allow"
    return Edit(comment.place, f"# regdb: {verb} {', '.join(rules)} --{reason}")


def _delete(file: SourceFile, place: Place) -> Edit:
    """Take out a comment with the space before it, or its whole line if it stands alone."""
    lines = file.text.split("\n")
    before = lines[place.line - 1][: place.column - 1]
    if not before.strip() and place.line < len(lines):
        return Edit(Place(place.path, place.line, 1, place.line + 1, 1), "")
    start = len(before.rstrip()) + 1
    return Edit(Place(place.path, place.line, start, place.line, place.end_column), "")


def _finding(code: str, place: Place, message: str, advice: str, fix: Fix | None = None) -> Diagnostic:
    name = next(name for known, name, _ in SUPPRESSION_RULES if known == code)
    return Diagnostic(code, name, "warning", message, place, help=advice, fix=fix)


def _listed(rules: tuple[str, ...]) -> str:
    return ", ".join(f"`{rule}`" for rule in rules)
