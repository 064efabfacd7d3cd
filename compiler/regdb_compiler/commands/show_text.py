"""What `regdb show` shows, as text for people."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from regdb.units import SI_SYMBOL, show_si, unit_named
from regdb.vocabulary import show_value
from regdb_compiler.commands.sheet import Sheet

Data = Mapping[str, Any]
MANY = 12
"""Names listed before `and ... more`."""


def show_text(data: Data, day: str, *, color: bool = False) -> str:
    """The data of `shown.shown` as sheets; `day` is the day in words."""
    sheet = Sheet(color=color)
    _WRITERS[data["shows"]](sheet, data)
    if "on" in data:
        sheet.gap()
        sheet.line(f"law as of {day}")
    return sheet.render()


def dates(item: Data) -> str:
    """`since 2002-01-01`, `2002-01-01 to 2031-01-01` (the end is no longer in force)."""
    start = item["effective"] or "ever"
    return f"{start} to {item['until']}" if item["until"] else f"since {start}"


def _law(sheet: Sheet, data: Data) -> None:
    """Regulations one by one, then the text of each section once."""
    if data["shows"] == "section":
        for section in data["sections"]:
            _section(sheet, section)
        for rule in data["regulations"]:
            _regulation(sheet, rule)
        return
    for rule in data["regulations"]:
        _regulation(sheet, rule)
        sheet.items("Source", [rule["source_url"], f"checked {rule['checked']}, {rule['confidence']}"])
    for section in data["sections"]:
        sheet.gap()
        sheet.field("Text of", f"{section['citation']} {section['title']}, {dates(section)}")
        sheet.passage(section["text"])


def _section(sheet: Sheet, item: Data) -> None:
    sheet.heading(f"{item['citation']}  {item['title']}")
    lapsed = "" if item["in_force"] else " (not in force on the day)"
    sheet.field("In force", dates(item) + lapsed + (f", {item['enacted_by']}" if item["enacted_by"] else ""))
    sheet.field("Where", ", ".join(item["location"]))
    sheet.field("Topic", item["topic"])
    _versions(sheet, item)
    sheet.items("Source", [item["source_url"], *item["source_also"], f"checked {item['checked']}, {item['confidence']}"])
    sheet.field("Note", item["note"])
    for definition in item["definitions"]:
        sheet.field("Defines", f"{definition['name']}: {definition['when_text']}")
    for delegation in item["delegations"]:
        sheet.field("Delegates", _delegation(delegation))
    sheet.gap()
    sheet.passage(item["text"])


def _delegation(item: Data) -> str:
    parts = [f"to {', '.join(item['kinds'])}"]
    parts += [f"{item['attribute']}, {item['direction']}"] if item["attribute"] else []
    parts += [f"at least {item['least']}"] if item["least"] else []
    parts += [f"at most {item['most']}"] if item["most"] else []
    parts += [f"one of {', '.join(item['allowed'])}"] if item["allowed"] else []
    parts += [f"of {', '.join(item['targets'])}"] if item["targets"] else []
    parts += ["only with its sign"] if item["sign"] else []
    parts += [f"not on roads of the {', '.join(item['not_on'])}"] if item["not_on"] else []
    return "; ".join(parts) + (f"; if {item['condition']}" if item["condition"] else "")


def _versions(sheet: Sheet, item: Data) -> None:
    if len(item["versions"]) > 1:
        sheet.items("Versions", [dates(version) for version in item["versions"]])


def _regulation(sheet: Sheet, rule: Data) -> None:
    sheet.heading(f"{rule['citation']}  {rule['title']}")
    lapsed = "" if rule["in_force"] else "   NOT IN FORCE ON THE DAY"
    sheet.line(f"  {rule['id']}, {rule['jurisdiction']}, {dates(rule)}{lapsed}")
    for label, name in (("Condition", "condition"), ("When", "when"), ("Unless", "unless"), ("Result", "result")):
        sheet.field(label, rule[name])
    sheet.field("Legality", "true: a permission" if rule["legality"] else "false: a prohibition")
    sheet.field("From", rule["current_states"] or "any state")
    sheet.field("To", rule["next_states"] or "any state")
    sheet.items("Limits", [_limit(limit, rule["force"]) for limit in rule["limits"]])
    scope = [f"{name}: {text}" for name, text in rule["attributes"].items() if name not in {item["attribute"] for item in rule["limits"]}]
    sheet.items("Scope", scope)
    sheet.field("Vehicles", ", ".join(rule["applies_to"]))
    sheet.field("Sign", rule["requires_sign"])
    sheet.field("Exception to", ", ".join(rule["exception_to"]))
    sheet.field("Overrides", ", ".join(rule["overrides"]))
    sheet.field("Authority", rule["authority"])
    sheet.items("Displaced by", [f"{item['id']} ({_spelled(item['kind'])})" for item in rule["displaced_by"]])
    sheet.field("Tags", ", ".join(rule["tags"]))
    sheet.field("Quote", f'"{rule["quote"]}"' if rule["quote"] else "")
    sheet.field("Vagueness", f"{rule['vagueness']}: {rule['vague_because']}" if rule["vagueness"] else "")
    _versions(sheet, rule)


def _spelled(kind: str) -> str:
    return "exception" if kind == "exception_to" else "override"


def _limit(limit: Data, force: str) -> str:
    symbol = SI_SYMBOL.get(unit_named(limit["unit"]).dimension, "")
    si = "" if limit["si"] is None or symbol == limit["unit"] else f" = {show_si(limit['si'], symbol)}"
    return f"{limit['attribute']} {limit['text']}{si} ({force}, {limit['direction']} of {limit['fact']})"


def _fact(sheet: Sheet, fact: Data) -> None:
    sheet.heading(f"{fact['name']}  ({fact['kind']}{', ' + fact['unit'] if fact['unit'] else ''})")
    sheet.field("Meaning", fact["meaning"])
    sheet.field("Source", fact["source"])
    sheet.field("Values", ", ".join(fact["words"]))
    assumed = "" if fact["assumed"] is None else _value(fact, fact["assumed"])
    within = f" within {fact['assumed_within']}" if fact["assumed_within"] else ""
    sheet.field("Unknown", f"taken as {assumed}{within}: {fact['assumed_because']}" if assumed else "strict: unknown stays unknown")
    sheet.field("Quiet", "" if fact["quiet"] is None else _value(fact, fact["quiet"]))
    sheet.items("Phrases", [f"{word}: {', '.join(said)}" if word else ", ".join(said) for word, said in fact["phrases"].items()])
    sheet.field("Confusables", ", ".join(fact["confusables"]))
    sheet.field("Codes", ", ".join(f"{name} {code}" for name, code in fact["codes"].items()))
    sheet.field("Read by", _many(fact["read_by"]))


def _value(fact: Data, value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return "[" + ", ".join(value) + "]"
    return value if isinstance(value, str) else show_value(float(value), fact["kind"], fact["unit"])


def _many(names: Iterable[str]) -> str:
    listed = list(names)
    rest = len(listed) - MANY
    return ", ".join(listed[:MANY]) + (f" and {rest} more" if rest > 0 else "") or "no regulation"


def _attribute(sheet: Sheet, item: Data) -> None:
    sheet.heading(f"{item['name']}  ({item['kind']} attribute)")
    sheet.field("Meaning", item["meaning"])
    sheet.field("Fact", item["fact"])
    sheet.field("Direction", item["direction"])
    sheet.field("Used by", _many(item["used_by"]))


def _definition(sheet: Sheet, data: Data) -> None:
    sheet.heading(f"{data['name']}  (definition)")
    for item in data["definitions"]:
        sheet.field(item["citation"], f"{item['when_text']}  ({dates(item)})")
        sheet.field("Quote", f'"{item["quote"]}"' if item["quote"] else "")


def _jurisdiction(sheet: Sheet, item: Data) -> None:
    sheet.heading(f"{item['name']}  ({item['kind']})")
    sheet.field("Id", f"{item['id']}, code {item['code']}")
    sheet.field("Status", item["status"])
    sheet.field("Under", " > ".join(item["path"][:-1]))
    sheet.field("Cited as", ", ".join(text for text in (item["short"], item["long"]) if text))
    sheet.field("Governs", ", ".join([*item["territory"], *(f"roads of the {owner}" for owner in item["road_owners"])]))
    sheet.field("Holds", f"{item['sections']} sections, {item['regulations']} regulations")
    sheet.field("Source", item["source"])


def _topic(sheet: Sheet, data: Data) -> None:
    sheet.heading(f"{data['name']}  (topic)")
    sheet.field("Sections", ", ".join(data["sections"]))
    for rule in data["regulations"]:
        sheet.gap()
        sheet.line(f"{rule['citation']}  {rule['id']}")
        sheet.field("Condition", rule["condition"])
        sheet.field("Result", rule["result"])


def _state(sheet: Sheet, data: Data) -> None:
    for item in data["super_states"]:
        sheet.heading(f"{item['name']}  (super-state)")
        sheet.field("Meaning", item["meaning"])
        sheet.field("Prompt", item["prompt"])
        sheet.field("Aliases", ", ".join(item["aliases"]))
        sheet.field("States", ", ".join(item["states"]))
        sheet.field("Followed by", ", ".join(item["next"]))
    for item in data["states"]:
        sheet.heading(f"{item['id']}  (state{', beyond the paper' if item['extension'] else ''})")
        sheet.field("Meaning", item["meaning"])
        sheet.field("Prompt", item["prompt"])
        sheet.field("Aliases", ", ".join(item["aliases"]))
        sheet.field("Next", ", ".join(item["next"]))
        sheet.field("Law from it", _many(item["regulations"]["current"]))
        sheet.field("Law to it", _many(item["regulations"]["next"]))


def _interpretation(sheet: Sheet, data: Data) -> None:
    sheet.heading(f"{data['name']}  (interpretation)  {data['title']}")
    sheet.field("Not law", "a choice of design: how a runtime decides facts for which the law has no number")
    sheet.field("Meaning", data["meaning"])
    sheet.items("Source", [data["source_url"], *data["source_also"], f"checked {data['checked']}, {data['confidence']}"])
    sheet.field("Note", data["note"])
    for rule in data["rules"]:
        sheet.gap()
        when = "never decided: stays unknown" if not rule["formula"] else f"true when {rule['true_when']} by {rule['formula']}"
        sheet.line(f"{rule['fact']}  {when}")
        sheet.field("Formula", rule["formula_meaning"])
        sheet.field("Parameters", ", ".join(f"{name} {item['text']}" for name, item in rule["parameters"].items()))
        sheet.field("Measures", ", ".join(rule["measures"]))
        sheet.field("Because", rule["because"])
        sheet.field("Drawn from", rule["source"])
        sheet.field("Read by", _many(rule["read_by"]))


def _machine(sheet: Sheet, data: Data) -> None:
    """Super-states with their states, and what may follow each; emergencies, which follow every state, are said once."""
    sheet.heading(f"State machine, starting in {data['initial']}")
    everywhere = {state for item in data["super_states"] if item["from_anywhere"] for state in item["states"]}
    states = {state["id"]: state for state in data["states"]}
    for item in data["super_states"]:
        reach = "entered from every state" if item["from_anywhere"] else f"entered by {item['entry']}, left by {item['exit']}"
        sheet.heading(f"{item['name']}  ({reach})")
        sheet.field("Meaning", item["meaning"])
        sheet.field("Followed by", ", ".join(item["next"]))
        for name in item["states"]:
            state = states[name]
            after = [other for other in state["next"] if other not in everywhere or item["from_anywhere"]]
            own = [other.removeprefix(f"{item['name']}.") for other in after]
            sheet.gap()
            sheet.line(f"  {name.partition('.')[2]}" + ("  (extension of the paper's machine)" if state["extension"] else ""))
            sheet.field("", f"-> {', '.join(own)}")


_WRITERS: dict[str, Callable[[Sheet, Data], None]] = {
    "regulation": _law, "section": _law, "fact": _fact, "attribute": _attribute, "definition": _definition,
    "jurisdiction": _jurisdiction, "topic": _topic, "state": _state,
    "interpretation": _interpretation, "machine": _machine,
}  # fmt: skip
