"""The world of a scene with SUMO's traffic: streets, ego, people on foot, lights and eye are the built-in world's."""

from __future__ import annotations

from regdb.vocabulary import Vocabulary
from regdb_runtime.worlds.built_in.ego import EgoSettings
from regdb_runtime.worlds.built_in.mover import TrafficSettings
from regdb_runtime.worlds.built_in.world import BuiltInWorld
from regdb_runtime.worlds.eye import Eye
from regdb_runtime.worlds.scene_spec import SceneSpec
from regdb_runtime.worlds.sumo.traffic import SumoTraffic


class SumoWorld(BuiltInWorld):
    """A running scene in SUMO; the same spec, seed and plans give the same bytes. `close` it: one process holds one simulation.

    Raises WorldError for a spec that does not fit together, and MissingExtra without libsumo.
    """

    def __init__(
        self, spec: SceneSpec, vocabulary: Vocabulary, eye: Eye | None = None,
        ego_settings: EgoSettings | None = None, traffic_settings: TrafficSettings | None = None,
    ) -> None:  # fmt: skip
        super().__init__(spec, vocabulary, eye, ego_settings, traffic_settings)
        own = self._traffic
        self._sumo = SumoTraffic(self._map, self._tables, self._signals, self._settings, spec.seed, self.footprint, self._route)
        for track in self._parked:
            self._sumo.add_standing(track)
        self._sumo.movers.extend(own.movers)
        self._traffic = self._sumo

    def close(self) -> None:
        self._sumo.close()
