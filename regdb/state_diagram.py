"""The state machine as a diagram: Mermaid (`stateDiagram-v2`) and Graphviz DOT, super-states as boxes around their states.

Transitions into a super-state that is entered from anywhere are drawn once, from a note, not from every state.
"""

from __future__ import annotations

from collections.abc import Iterator

from regdb.states import StateMachine, SuperState

INDENT = "    "


def to_mermaid(machine: StateMachine) -> str:
    """The machine as Mermaid's `stateDiagram-v2`; extensions of the paper's machine carry a star."""
    lines = ["stateDiagram-v2", f"{INDENT}[*] --> {machine.initial}"]
    for item in machine.super_states.values():
        lines.append(f'{INDENT}state "{_title(item.name)}" as {item.name} {{')
        lines.append(f"{INDENT * 2}[*] --> {_node(item.name, item.entry)}")
        lines += [f'{INDENT * 2}state "{_label(machine, key)}" as {_id(key)}' for key in _own(machine, item)]
        lines += [f"{INDENT * 2}{_id(current)} --> {_id(after)}" for current, after in within(machine, item)]
        lines.append(f"{INDENT}}}")
    lines += [f"{INDENT}{_id(current)} --> {_id(after)}" for current, after in between(machine)]
    for item in machine.super_states.values():
        if item.from_anywhere:
            lines.append(f"{INDENT}note right of {item.name} : entered from every state")
    return "\n".join(lines) + "\n"


def to_dot(machine: StateMachine) -> str:
    """The machine as a Graphviz digraph with one cluster for each super-state."""
    lines = ["digraph states {", f"{INDENT}compound=true; rankdir=LR; node [shape=box, style=rounded];"]
    for item in machine.super_states.values():
        said = " (entered from every state)" if item.from_anywhere else ""
        lines.append(f'{INDENT}subgraph "cluster_{item.name}" {{')
        lines.append(f'{INDENT * 2}label="{_title(item.name)}{said}";')
        for key in _own(machine, item):
            start = ", penwidth=2" if machine.states[key].name == item.entry else ""
            lines.append(f'{INDENT * 2}"{key}" [label="{_label(machine, key)}"{start}];')
        lines += [f'{INDENT * 2}"{current}" -> "{after}";' for current, after in within(machine, item)]
        lines.append(f"{INDENT}}}")
    lines += [f'{INDENT}"{current}" -> "{after}";' for current, after in between(machine)]
    return "\n".join([*lines, "}", ""])


def within(machine: StateMachine, item: SuperState) -> Iterator[tuple[str, str]]:
    """Transitions inside one super-state, as declared."""
    own = _own(machine, item)
    for key in own:
        yield from ((key, after) for after in machine.states[key].next if after in own)


def between(machine: StateMachine) -> Iterator[tuple[str, str]]:
    """Transitions from one super-state to another, save those into one that is entered from anywhere."""
    for state in machine.states.values():
        for after in state.next:
            other = machine.super_states[machine.states[after].super_state]
            if other.name != state.super_state and not other.from_anywhere:
                yield state.id, after


def _own(machine: StateMachine, item: SuperState) -> tuple[str, ...]:
    return tuple(state.id for state in machine.states.values() if state.super_state == item.name)


def _label(machine: StateMachine, state_id: str) -> str:
    state = machine.states[state_id]
    return state.name.replace("_", " ") + (" *" if state.extension else "")


def _title(name: str) -> str:
    return name.replace("_", " ").capitalize()


def _node(super_state: str, name: str) -> str:
    return f"{super_state}__{name}"


def _id(state_id: str) -> str:
    return state_id.replace(".", "__")
