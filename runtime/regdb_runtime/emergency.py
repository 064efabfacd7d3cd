"""The emergency check: braking by distance alone, in a path that touches neither perception's model nor law nor map."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class EmergencyReport:
    """What the check measured: nearest gap in the swept corridor, the distance it must not fall below (metres), and the track it is to."""

    active: bool
    gap: float | None
    required: float
    track: str | None
