"""From a scene's description to a running world, with the shipped vocabulary where none is given."""

from __future__ import annotations

from functools import lru_cache

from regdb.front import database
from regdb.vocabulary import Vocabulary
from regdb_runtime.database import RegulationDatabase
from regdb_runtime.worlds.built_in.world import BuiltInWorld
from regdb_runtime.worlds.eye import Eye
from regdb_runtime.worlds.scene_spec import SceneSpec


def build(spec: SceneSpec, vocabulary: Vocabulary | None = None, eye: Eye | None = None) -> BuiltInWorld:
    """The world of a scene; `eye` replaces the scene's own. Raises WorldError for a scene that does not fit together."""
    return BuiltInWorld(spec, vocabulary or shipped_vocabulary(), eye)


@lru_cache(maxsize=1)
def shipped_vocabulary() -> Vocabulary:
    """The vocabulary of the codes found from here, read once."""
    return RegulationDatabase.open(database()).vocabulary
