"""The options of `regdb drive`, as typed, and how a database is opened for it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Options:
    """What all ways of driving are asked; each takes what concerns it."""

    out: Path | None
    variants: tuple[str, ...]
    world: str
    eye: str
    record: Path | None
    profile: str
    seed: int | None
    db: Path | None
    figures: bool
    form: str
    vehicles: tuple[str, ...] = ()
    place: str = ""
    on: str = ""
    route: str = ""
    lights: str = "red"
    interpretation: str = ""
    error_rate: float | None = None

    @property
    def folder(self) -> Path:
        """Where outputs go."""
        return self.out if self.out is not None else Path("out") / "drive"
