"""A lint rule as a value: its code, name, level, page, and the function that finds the offence."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from types import ModuleType
from typing import Any, get_args

from regdb_compiler.diagnostics import Diagnostic, Level
from regdb_compiler.driver import Build
from regdb_compiler.lint.page import Page, read_page

Check = Callable[[Build], Iterator[Diagnostic]]
_CODE = re.compile(r"[A-Z]{1,4}[0-9]{3,4}\Z")
_NAME = re.compile(r"[a-z]+(-[a-z]+)*\Z")


class RuleError(Exception):
    """A module that is no lint rule; the message says what it lacks."""


@dataclass(frozen=True)
class Rule:
    """One rule. `origin` is the module that it stands in."""

    code: str
    name: str
    level: Level
    check: Check
    text: str
    origin: str

    @cached_property
    def page(self) -> Page:
        """What `regdb rule` shows."""
        return read_page(self.text)


def rule_of(module: ModuleType) -> Rule:
    """The rule that a module is. Raises RuleError, saying what the module lacks."""
    where = module.__name__
    code, name, check = (getattr(module, word, None) for word in ("CODE", "NAME", "check"))
    level: Any = getattr(module, "LEVEL", None)
    if not isinstance(code, str) or not _CODE.match(code):
        raise RuleError(f"{where} has no CODE such as R310 or ACME101")
    if not isinstance(name, str) or not _NAME.match(name):
        raise RuleError(f"{where} has no NAME such as limit-without-force")
    if level not in get_args(Level):
        raise RuleError(f"{where} has no LEVEL; it is one of {', '.join(get_args(Level))}")
    if not callable(check):
        raise RuleError(f"{where} has no function check(build)")
    return Rule(code, name, level, check, module.__doc__ or "", where)
