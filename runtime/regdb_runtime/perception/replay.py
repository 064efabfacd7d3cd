"""What a model said, kept as JSONL and said again: by the hash of frame and prompt, or by the nearest time of capture."""

from __future__ import annotations

import hashlib
import json
import time
from bisect import bisect_left
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal, get_args

from regdb_runtime.errors import LogError
from regdb_runtime.observation import Provenance
from regdb_runtime.perception.describer import Closing, Describer, Description, Failure, Frame, Prompt

VERSION = 1


def frame_hash(frame: Frame) -> str:
    """SHA-256 of the image's bytes, 32 hexadecimal digits."""
    return hashlib.sha256(frame.image).hexdigest()[:32]


def prompt_hash(prompt: Prompt) -> str:
    """SHA-256 of all that is asked: text, schema, earlier turns, crop, length of the answer; 32 hexadecimal digits."""
    asked = [prompt.text, prompt.schema, prompt.history, prompt.crop, prompt.max_tokens]
    return hashlib.sha256(json.dumps(asked, sort_keys=True, default=list).encode()).hexdigest()[:32]


@dataclass(frozen=True)
class Entry:
    """One line of a record. `captured`: seconds since the run began. `prompt`: its text, `name`: the state it was asked in."""

    frame: str
    prompt_hash: str
    captured: float
    description: Description
    prompt: str = ""
    name: str = ""
    id: str = ""

    @classmethod
    def of(cls, frame: Frame, prompt: Prompt, description: Description) -> Entry:
        """What is kept of one call."""
        return cls(frame_hash(frame), prompt_hash(prompt), frame.captured, description, prompt.text, prompt.name, frame.id)

    def to_line(self) -> str:
        """One line of JSON."""
        found = self.description
        return json.dumps(
            {
                "version": VERSION, "frame": self.frame, "prompt_hash": self.prompt_hash, "captured": self.captured, "id": self.id,
                "name": self.name, "prompt": self.prompt, "text": found.text, "failure": found.failure, "detail": found.detail,
                "took": found.took, "model": found.model, "usage": dict(found.usage), "cut": found.cut,
            },
            ensure_ascii=False,
        )  # fmt: skip

    @classmethod
    def read(cls, raw: Mapping[str, Any]) -> Entry:
        """The entry of a line. Raises ValueError, KeyError or TypeError."""
        if raw["version"] != VERSION:
            raise ValueError(f"it has version {raw['version']}, this reads version {VERSION}")
        failure: Failure = raw["failure"]
        if failure not in get_args(Failure):
            raise ValueError(f"{failure!r} is no failure")
        usage = {str(name): int(count) for name, count in raw["usage"].items()}
        said = Description(str(raw["text"]), failure, str(raw["detail"]), float(raw["took"]), str(raw["model"]), usage, bool(raw["cut"]))
        return cls(str(raw["frame"]), str(raw["prompt_hash"]), float(raw["captured"]), said, str(raw["prompt"]), str(raw["name"]), str(raw["id"]))


class Recorder:
    """A describer that writes down what another one says, a line a call, at once. A disk that is full costs the record, not the drive:
    `broken` then says why nothing is written any more."""

    def __init__(self, describer: Describer, path: Path) -> None:
        self._describer, self._path = describer, path
        self.broken = ""
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()

    @property
    def provenance(self) -> Provenance:
        """The other's."""
        return self._describer.provenance

    def describe(self, frame: Frame, prompt: Prompt, deadline: float) -> Description:
        """What the other one says."""
        found = self._describer.describe(frame, prompt, deadline)
        if not self.broken:
            try:
                with self._path.open("a", encoding="utf-8") as file:
                    file.write(Entry.of(frame, prompt, found).to_line() + "\n")
            except OSError as error:
                self.broken = str(error)
        return found

    def close(self) -> None:
        """Close the other."""
        if isinstance(self._describer, Closing):
            self._describer.close()


def read_record(path: Path) -> tuple[Entry, ...]:
    """The entries of a record. A last line without its end was being written when the run ended, and is left out. Raises LogError."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise LogError(f"{path} cannot be read: {error}") from None
    lines = text.split("\n")[:-1]
    found = []
    for number, line in enumerate(lines, 1):
        if line.strip():
            try:
                found.append(Entry.read(json.loads(line)))
            except (ValueError, KeyError, TypeError, AttributeError) as error:
                raise LogError(f"{path}:{number}: no line of a record of a vision model: {error}") from None
    return tuple(found)


@dataclass
class ReplayDescriber:
    """Says what was recorded. `by`: `hash` finds the call with the same frame and prompt (asked again, the next one that was recorded, then
    the last one over and over); `time` the one captured nearest to the frame, within `within` seconds, among those of the same prompt where
    there are any, else among all. `paced`: an answer takes as long as it did then, so that it may miss the deadline as it did then.
    """

    entries: Iterable[Entry]
    by: Literal["hash", "time"] = "hash"
    within: float = 0.5
    paced: bool = False
    sleep: Callable[[float], None] = time.sleep
    provenance: Provenance = field(default="recorded", init=False)

    def __post_init__(self) -> None:
        ordered = sorted(self.entries, key=lambda entry: entry.captured)
        self._by_hash: dict[tuple[str, str], list[Entry]] = {}
        self._by_prompt: dict[str, list[Entry]] = {"": ordered}
        for entry in ordered:
            self._by_hash.setdefault((entry.frame, entry.prompt_hash), []).append(entry)
            self._by_prompt.setdefault(entry.prompt_hash, []).append(entry)

    @classmethod
    def read(cls, path: Path, by: Literal["hash", "time"] = "hash", within: float = 0.5, *, paced: bool = False) -> ReplayDescriber:
        """From a file. Raises LogError."""
        return cls(read_record(path), by, within, paced)

    def describe(self, frame: Frame, prompt: Prompt, deadline: float) -> Description:
        """What was said then; a failure where nothing was recorded."""
        entry = self._same(frame, prompt) if self.by == "hash" else self._nearest(frame, prompt)
        if entry is None:
            return Description("", "connection", "nothing was recorded of this frame and prompt")
        found = entry.description
        if self.paced:
            self.sleep(min(found.took, deadline))
            if found.took > deadline and not found.failure:
                return Description("", "deadline", f"the recorded answer took {found.took:.2f} s", deadline, found.model)
        return found

    def _same(self, frame: Frame, prompt: Prompt) -> Entry | None:
        found = self._by_hash.get((frame_hash(frame), prompt_hash(prompt)))
        if not found:
            return None
        return found.pop(0) if len(found) > 1 else found[0]

    def _nearest(self, frame: Frame, prompt: Prompt) -> Entry | None:
        entries = self._by_prompt.get(prompt_hash(prompt)) or self._by_prompt[""]
        place = bisect_left(entries, frame.captured, key=lambda entry: entry.captured)
        near = entries[max(place - 1, 0) : place + 1]
        best = min(near, key=lambda entry: abs(entry.captured - frame.captured), default=None)
        return best if best is not None and abs(best.captured - frame.captured) <= self.within else None
