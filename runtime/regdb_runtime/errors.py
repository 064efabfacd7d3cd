"""Every error the runtime raises, as one tree.

RegdbRuntimeError
├── DatabaseError          the file cannot be used
│   ├── NotADatabase       not SQLite, or SQLite of somebody else
│   ├── VersionRefused     a schema of another major version
│   └── DatabaseDamaged    truncated, altered, or with rows that mean nothing
├── RequestError           a place, date or state that is not there
├── MapError               a map file that cannot be read
├── NoRoute                no lanes lead from here to there
├── OutsideDomain          a point that a reference path cannot place
├── LogError               a file that is no log of a drive
├── WorldError             a scene, or a record of perception, that cannot be built
├── ModelError             a vision model that cannot be loaded
└── MissingExtra           an optional library is needed; says what to type
"""


class RegdbRuntimeError(Exception):
    """What everything below is; the message is one sentence for a person."""


class DatabaseError(RegdbRuntimeError):
    """A database file that cannot be used."""


class NotADatabase(DatabaseError):  # noqa: N818  # reads as what it says
    """A file that is not a regulation database at all."""


class VersionRefused(DatabaseError):  # noqa: N818
    """A database of a schema this runtime does not speak."""


class DatabaseDamaged(DatabaseError):  # noqa: N818
    """A database that is not as its compiler left it."""


class RequestError(RegdbRuntimeError, ValueError):
    """A question about a place, date or state that the database does not know."""


class OutsideDomain(RegdbRuntimeError, ValueError):  # noqa: N818
    """A station beyond a path's ends, or an offset at or beyond its centre of curvature; the other of the two is None."""

    def __init__(self, message: str, station: float | None = None, offset: float | None = None) -> None:
        super().__init__(message)
        self.station, self.offset = station, offset


class LogError(RegdbRuntimeError):
    """A file that is no log of a drive, is cut off, or has another version."""


class MapError(RegdbRuntimeError, ValueError):
    """A map or scenario file that cannot be read; names the file, the element and what is wrong with it."""


class NoRoute(RegdbRuntimeError):  # noqa: N818
    """No lanes that a vehicle may use lead from the one to the other."""


class WorldError(RegdbRuntimeError, ValueError):
    """A scene, or a record of perception, that no world can be built from; the message names the place in it."""


class ModelError(RegdbRuntimeError):
    """A vision model that is not on this machine, or that this machine cannot run; the message says what to do."""


class MissingExtra(RegdbRuntimeError):  # noqa: N818
    """A library that is not installed; the message carries the exact command that installs it."""

    def __init__(self, library: str, extra: str, purpose: str) -> None:
        super().__init__(f"{purpose} needs {library}: pip install 'regdb[{extra}]'")
