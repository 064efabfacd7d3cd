"""How many findings of each level, in how many files, and how many of them a command can fix."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from regdb_compiler.diagnostics import Diagnostic


@dataclass(frozen=True, slots=True)
class Summary:
    """Counts over all findings."""

    errors: int
    warnings: int
    infos: int
    files: int
    fixable: int

    def __str__(self) -> str:
        counted = ((self.errors, "error", "errors"), (self.warnings, "warning", "warnings"), (self.infos, "info", "info"))
        told = ", ".join(f"{count} {one if count == 1 else many}" for count, one, many in counted if count)
        if not told:
            return "no findings"
        fixable = f" ({self.fixable} fixable with --fix)" if self.fixable else ""
        return f"{told} in {self.files} {'file' if self.files == 1 else 'files'}{fixable}"


def summarize(diagnostics: Iterable[Diagnostic]) -> Summary:
    """Count the findings."""
    findings = tuple(diagnostics)
    levels = Counter(finding.level for finding in findings)
    return Summary(
        errors=levels["error"],
        warnings=levels["warning"],
        infos=levels["info"],
        files=len({finding.place.path for finding in findings}),
        fixable=sum(1 for finding in findings if finding.fix and finding.fix.kind == "safe"),
    )
