"""The database file: its identity, version, tables and views. Both sides follow this module and nothing else."""

APPLICATION_ID = 0x52474442
"""SQLite's application_id: "RGDB"."""

MAJOR, MINOR = 1, 2
"""Schema version. A reader refuses another major; a minor only adds."""

USER_VERSION = MAJOR * 1000 + MINOR
"""What stands in SQLite's user_version."""

PAPER_COLUMNS = (
    "Code Text",
    "Condition",
    "Result",
    "Legality",
    "Attribute: Road Type",
    "Attribute: Max Speed",
    "Possible Current States",
    "Possible Next States",
)
"""Table I of the paper, in its order."""


def text(name: str, *, null: bool = False) -> str:
    """A TEXT column whose values are text for readers of any age (CHECK rather than STRICT)."""
    if null:
        return f"{name} TEXT CHECK ({name} IS NULL OR typeof({name}) = 'text')"
    return f"{name} TEXT NOT NULL CHECK (typeof({name}) = 'text')"


def integer(name: str) -> str:
    return f"{name} INTEGER NOT NULL CHECK (typeof({name}) = 'integer')"


def flag(name: str) -> str:
    return f"{name} INTEGER NOT NULL CHECK ({name} IN (0, 1))"


def real(name: str) -> str:
    return f"{name} REAL CHECK ({name} IS NULL OR typeof({name}) IN ('real', 'integer'))"


TABLES: dict[str, tuple[str, ...]] = {
    "regdb_meta": ("key TEXT PRIMARY KEY", text("value")),
    "jurisdiction": (
        "id TEXT PRIMARY KEY", text("name"), text("kind"), text("status"), "parent TEXT REFERENCES jurisdiction(id)",
        text("code"), text("short"), text("long"), text("territory"), text("road_owners"), text("source"),
    ),
    "super_state": (
        "name TEXT PRIMARY KEY", integer("position"), text("meaning"), text("prompt"), text("next"), text("entry"), text("exit"),
        text("aliases"), flag("from_anywhere"), flag("initial"),
    ),
    "state": (
        "id TEXT PRIMARY KEY", integer("position"), "super_state TEXT NOT NULL REFERENCES super_state(name)", text("name"),
        text("meaning"), text("prompt"), text("aliases"), flag("extension"),
    ),
    "transition": (
        "current TEXT NOT NULL REFERENCES state(id)", "next TEXT NOT NULL REFERENCES state(id)", "PRIMARY KEY (current, next)",
    ),
    "fact": (
        "name TEXT PRIMARY KEY", text("kind"), text("meaning"), text("source"), text("words"), text("unit"), text("dimension"),
        text("assumed", null=True), text("assumed_within"), text("assumed_because"), text("quiet", null=True), text("phrases"),
        text("confusables"), text("codes"),
    ),
    "fact_fusion": (
        "fact TEXT PRIMARY KEY REFERENCES fact(name)", text("ages"), real("holds_s"), real("holds_m"), real("fresh_s"), real("fresh_m"),
        "confirmations INTEGER NOT NULL CHECK (confirmations >= 1)", "within_s REAL NOT NULL", "apart_s REAL NOT NULL", flag("replaced"),
        text("permissive"), real("permissive_above"), real("permissive_below"), text("corroboration"), text("strictest"), real("least"),
        real("most"), real("step"), text("asks"), text("question"), text("ends"), text("places"), text("because"),
    ),
    "attribute": (
        "name TEXT PRIMARY KEY", text("kind"), "fact TEXT NOT NULL REFERENCES fact(name)", text("direction"), text("meaning"),
    ),
    "section": (
        "id TEXT PRIMARY KEY", "jurisdiction TEXT NOT NULL REFERENCES jurisdiction(id)", text("number"), text("citation"),
        text("title"), text("location"), text("topic"), text("source_url"), text("source_also"), text("checked"), text("confidence"),
        text("note"),
    ),
    "section_version": (
        "key INTEGER PRIMARY KEY", "section TEXT NOT NULL REFERENCES section(id)", text("effective"), text("until", null=True),
        text("enacted_by"), text("text"), "UNIQUE (section, effective)",
    ),
    "definition": (
        "key INTEGER PRIMARY KEY", "section_version INTEGER NOT NULL REFERENCES section_version(key)", text("name"),
        text("when_text"), text("when_tree"), text("quote"),
    ),
    "delegation": (
        "key INTEGER PRIMARY KEY", "section_version INTEGER NOT NULL REFERENCES section_version(key)", text("citation"),
        text("kinds"), text("attribute"), text("direction"), text("least"), text("most"), text("allowed"), text("targets"),
        flag("sign"), text("not_on"), text("condition"),
    ),
    "regulation": (
        "key INTEGER PRIMARY KEY", text("id"), "section_version INTEGER NOT NULL REFERENCES section_version(key)",
        "jurisdiction TEXT NOT NULL REFERENCES jurisdiction(id)", text("citation"), text("title"), text("topic"), flag("legality"),
        text("effective", null=True), text("until", null=True), text("condition"), text("when_text"), text("unless_text"),
        text("when_tree"), text("unless_tree", null=True), text("result"), text("force"), text("attributes"), text("current_states"),
        text("next_states"), text("authority"), text("requires_sign"), text("applies_to"), text("tags"), text("quote"),
        "vagueness INTEGER NOT NULL CHECK (vagueness BETWEEN 0 AND 5)", text("vague_because"), text("confidence"),
        "UNIQUE (id, effective)",
    ),
    "regulation_limit": (
        "regulation INTEGER NOT NULL REFERENCES regulation(key)", integer("position"),
        "attribute TEXT NOT NULL REFERENCES attribute(name)", "fact TEXT NOT NULL REFERENCES fact(name)",
        "direction TEXT NOT NULL CHECK (direction IN ('max', 'min'))", text("bound"), real("value"), text("unit"), real("si"),
        text("law_text"), "PRIMARY KEY (regulation, position)",
    ),
    "regulation_state": (
        "regulation INTEGER NOT NULL REFERENCES regulation(key)", "role TEXT NOT NULL CHECK (role IN ('current', 'next'))",
        "state TEXT NOT NULL REFERENCES state(id)", "PRIMARY KEY (regulation, role, state)",
    ),
    "regulation_target": (
        "regulation INTEGER NOT NULL REFERENCES regulation(key)", integer("position"), text("target"),
        "kind TEXT NOT NULL CHECK (kind IN ('exception_to', 'overrides'))", "PRIMARY KEY (regulation, position)",
    ),
    "interpretation": (
        "name TEXT PRIMARY KEY", text("title"), text("meaning"), text("source_url"), text("source_also"), text("checked"),
        text("confidence"), text("note"),
    ),
    "interpretation_rule": (
        "interpretation TEXT NOT NULL REFERENCES interpretation(name)", "fact TEXT NOT NULL REFERENCES fact(name)", text("formula"),
        "true_when TEXT NOT NULL CHECK (true_when IN ('unsafe', 'safe'))", text("parameters"), text("because"), text("source"),
        "PRIMARY KEY (interpretation, fact)",
    ),
    "lexicon": (
        "kind TEXT NOT NULL CHECK (kind IN ('words', 'entails'))", text("name"), text("entries"), "PRIMARY KEY (kind, name)",
    ),
}  # fmt: skip
"""Table -> column and constraint clauses. JSON stands in text columns; dates are ISO text, NULL where open."""

SINCE_MINOR = {"interpretation": 1, "interpretation_rule": 1, "lexicon": 2, "fact_fusion": 2}
"""The minor version that brought a table; all others were there from the first. A file of an earlier minor lacks it."""

INDEXES = {
    "regulation_by_id": "regulation (id)",
    "regulation_by_topic": "regulation (topic)",
    "regulation_by_place_and_date": "regulation (jurisdiction, effective, until)",
    "regulation_state_by_state": "regulation_state (state, role)",
    "regulation_target_by_target": "regulation_target (target)",
}

SEARCH_TABLE = "regulation_search"
SEARCH_COLUMNS = ("id", "citation", "title", "condition", "result", "text")
"""Columns of the full-text index. It keeps no copy of the words: it reads them from the view `search_source`."""

VIEWS = {
    "paper_table": """
SELECT v.text AS "Code Text", r.condition AS "Condition", r.result AS "Result",
       CASE r.legality WHEN 1 THEN 'TRUE' ELSE 'FALSE' END AS "Legality",
       coalesce(json_extract(r.attributes, '$.road_type'), '') AS "Attribute: Road Type",
       coalesce(json_extract(r.attributes, '$.max_speed'), '') AS "Attribute: Max Speed",
       r.current_states AS "Possible Current States", r.next_states AS "Possible Next States"
FROM regulation r JOIN section_version v ON v.key = r.section_version ORDER BY r.key""",
    "in_force": """
SELECT r.* FROM regulation r
WHERE coalesce(r.effective, '') <= date('now') AND (r.until IS NULL OR date('now') < r.until)""",
    "transition_table": """
SELECT t.current, t.next, r.id, r.citation, r.legality, r.condition, r.result
FROM transition t JOIN regulation r
  ON (NOT EXISTS (SELECT 1 FROM regulation_state s WHERE s.regulation = r.key AND s.role = 'current')
      OR EXISTS (SELECT 1 FROM regulation_state s WHERE s.regulation = r.key AND s.role = 'current' AND s.state = t.current))
 AND (NOT EXISTS (SELECT 1 FROM regulation_state s WHERE s.regulation = r.key AND s.role = 'next')
      OR EXISTS (SELECT 1 FROM regulation_state s WHERE s.regulation = r.key AND s.role = 'next' AND s.state = t.next))""",
    "speed_limits": """
SELECT r.id, r.citation, r.jurisdiction, l.attribute, l.value, l.unit, l.si, r.force, r.condition, r.effective, r.until
FROM regulation_limit l JOIN regulation r ON r.key = l.regulation
WHERE l.attribute IN ('max_speed', 'min_speed') ORDER BY r.key, l.position""",
    "search_source": """
SELECT r.key, r.id, r.citation, r.title, r.condition, r.result, v.text
FROM regulation r JOIN section_version v ON v.key = r.section_version""",
    "overrides_of": """
SELECT t.target AS overridden, r.id AS overriding, t.kind, r.citation, r.jurisdiction, r.authority, r.effective, r.until
FROM regulation_target t JOIN regulation r ON r.key = t.regulation ORDER BY t.target, r.key""",
}

META_KEYS = ("schema_version", "regdb_version", "content_hash", "sources", "licence", "notice", "codes", "regulations")
NOTICE = "Not legal advice. Check the official text before relying on any entry."
LICENCE = "Apache-2.0"
