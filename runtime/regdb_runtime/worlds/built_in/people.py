"""Pedestrians on their paths: they stand, walk from a time on or once the ego is near, and stand again."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from regdb_runtime.observation import Track
from regdb_runtime.worlds.scene_spec import PedestrianSpec

ARM = 0.6
"""How far before others a pedestrian stops, metres."""


class Pedestrian:
    """One person on foot and how far along the path he or she is."""

    def __init__(self, spec: PedestrianSpec) -> None:
        self.spec = spec
        self.walked = 0.0
        self.walking = False
        self._legs = [(a, b, math.dist(a, b)) for a, b in pairwise(spec.path) if math.dist(a, b) > 0.0]
        self.length = sum(leg[2] for leg in self._legs)

    @property
    def moving(self) -> bool:
        return self.walking and bool(self._legs) and (self.spec.back_and_forth or self.walked < self.length)

    def step(self, time: float, duration: float, ego_front: tuple[float, float], in_the_way: Sequence[Track] = ()) -> None:
        """Walk on from `time` for `duration` seconds; nobody walks into what stands or drives right ahead."""
        near = self.spec.when_near is None or math.dist(ego_front, self.spec.path[0]) <= self.spec.when_near
        if not self.walking and time >= self.spec.starts - 1e-9 and near:
            self.walking = True
        if self.walking and not self._blocked(in_the_way):
            self.walked += self.spec.speed * duration
            if not self.spec.back_and_forth:
                self.walked = min(self.walked, self.length)

    def _blocked(self, others: Sequence[Track]) -> bool:
        x, y, heading = self.place()
        ahead_x, ahead_y = x + ARM * math.cos(heading), y + ARM * math.sin(heading)
        for other in others:
            if abs(other.x - x) + abs(other.y - y) < 20.0:
                dx, dy = ahead_x - other.x, ahead_y - other.y
                cos, sin = math.cos(other.heading), math.sin(other.heading)
                reach = self.spec.size / 2
                if abs(cos * dx + sin * dy) < other.length / 2 + reach and abs(cos * dy - sin * dx) < other.width / 2 + reach:
                    return True
        return False

    def place(self) -> tuple[float, float, float]:
        """(x, y, heading) now."""
        if not self._legs:
            return *self.spec.path[0], 0.0
        along, turned = self.walked, False
        if self.spec.back_and_forth:
            along = math.fmod(self.walked, 2 * self.length)
            if along > self.length:
                along, turned = 2 * self.length - along, True
        leg = 0
        while leg < len(self._legs) - 1 and along > self._legs[leg][2]:
            along -= self._legs[leg][2]
            leg += 1
        (ax, ay), (bx, by), reach = self._legs[leg]
        part = min(along / reach, 1.0)
        heading = math.atan2(by - ay, bx - ax) + (math.pi if turned else 0.0)
        return ax + part * (bx - ax), ay + part * (by - ay), math.remainder(heading, 2 * math.pi)

    def track(self) -> Track:
        """As the ego's sensors see this person."""
        x, y, heading = self.place()
        size = self.spec.size
        return Track(self.spec.id, "pedestrian", x, y, heading, self.spec.speed if self.moving else 0.0, size, size)
