"""The built-in world: a kinematic bicycle among vehicles, cyclists and pedestrians that behave like people, the same for the same seed."""

from regdb_runtime.worlds.built_in.build import build
from regdb_runtime.worlds.built_in.contacts import Contact
from regdb_runtime.worlds.built_in.world import BuiltInWorld

__all__ = ["BuiltInWorld", "Contact", "build"]
