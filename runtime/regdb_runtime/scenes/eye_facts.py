"""What perception's own report adds to a scene: its facts beside the map's, the stricter reading where both speak."""

from __future__ import annotations

from collections.abc import Mapping

from regdb.vocabulary import Value
from regdb_runtime.observation import Observation
from regdb_runtime.scenes.merging import merge

TRACKS = "tracks"
"""In `Observation.silent`: no list of road users is kept, so what the eye says of roles stands alone."""
NEVER = frozenset(("clock", "plan", "history", "motion", "nobody", "ego"))
"""Tellers whose facts perception does not tell."""


class EyeReport:
    """One report, sorted by who else tells its facts."""

    def __init__(self, observation: Observation, asked: Mapping[str, str]) -> None:
        self.facts, self.silent = observation.facts, observation.silent
        self.has_tracks = TRACKS not in observation.silent
        mine: dict[str, Value] = {}
        self.lights: dict[str, Value] = {}
        self.roles: dict[str, Value] = {}
        for name, value in observation.facts.items():
            teller = asked.get(name, "nobody")
            if teller == "light":
                self.lights[name] = value
            elif teller in ("track", "judged") and self.has_tracks:
                if value is True:
                    self.roles[name] = value
            elif teller not in NEVER:
                mine[name] = value
        self._mine = mine

    def is_of(self, observation: Observation) -> bool:
        """Whether another observation reports the same."""
        same = observation.facts is self.facts or observation.facts == self.facts
        return same and (observation.silent is self.silent or observation.silent == self.silent)

    def added_to(self, facts: dict[str, Value], lights_elsewhere: bool) -> dict[str, Value]:
        """Those facts with the report's own. Its word on signals counts where the map has no lights to ask (`lights_elsewhere` false)."""
        merge(facts, self._mine)
        if not lights_elsewhere:
            facts |= self.lights
        return facts

    def signal(self) -> dict[str, Value]:
        """What the eye says of the signal where the map has lights and none of them is reported: a colour, or nothing at all."""
        return self.lights if self.lights.get("signal.color", "none") != "none" else {}
