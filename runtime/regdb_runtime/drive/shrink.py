"""A scene that fails, made smaller while it still fails the same way: fewer road users, fewer things reported, a shorter time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

from regdb_runtime.worlds.scene_spec import SceneSpec

PARTS = ("flows", "vehicles", "cyclists", "pedestrians", "parked")


def shrink(spec: SceneSpec, fails: Callable[[SceneSpec], bool], most: int = 60) -> SceneSpec:
    """The smallest scene found in which `fails` still holds, trying at most so many; the scene itself where none smaller does."""
    tried = 0
    smaller = True
    while smaller and tried < most:
        smaller = False
        for candidate in _without(spec):
            tried += 1
            if tried > most:
                break
            if fails(candidate):
                spec, smaller = candidate, True
                break
    return replace(spec, name=f"{spec.name}_small") if not spec.name.endswith("_small") else spec


def _without(spec: SceneSpec) -> Iterator[SceneSpec]:
    """Scenes that lack something: first all of a kind, then one at a time, then signs, zones and sightings."""
    for name in PARTS:
        if len(getattr(spec, name)) > 1:
            yield _with(spec, name, ())
    for name in PARTS:
        items = getattr(spec, name)
        for index in range(len(items)):
            yield _with(spec, name, (*items[:index], *items[index + 1 :]))
    for index in range(len(spec.streets.zones)):
        zones = spec.streets.zones
        yield replace(spec, streets=replace(spec.streets, zones=(*zones[:index], *zones[index + 1 :])))
    for index in range(len(spec.eye.sightings)):
        sightings = spec.eye.sightings
        yield replace(spec, eye=replace(spec.eye, sightings=(*sightings[:index], *sightings[index + 1 :])))


def _with(spec: SceneSpec, name: str, items: tuple[Any, ...]) -> SceneSpec:
    changes: dict[str, Any] = {name: items}
    return replace(spec, **changes)
