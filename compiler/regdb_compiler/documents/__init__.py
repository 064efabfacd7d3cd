"""The fields authors may write, as pydantic models: section, cases, outline, vocabulary, jurisdictions, states, interpretations.

Every scalar arrives as text and gets its type here. Places are not kept in the models: `parse` maps a field's path to its node.
"""

from regdb_compiler.documents.language import (
    Age,
    Assumed,
    Attribute,
    CitationStyle,
    Fact,
    Fusion,
    Governs,
    Jurisdiction,
    JurisdictionsFile,
    Plausible,
    State,
    StatesFile,
    SuperState,
    VocabularyFile,
)
from regdb_compiler.documents.outline import Account, Outline, OutlineArticle, OutlineChapter, OutlineSection, Sections
from regdb_compiler.documents.scalars import Boolean, Date, Document, Force, Integer, Raw, Slug, Subdivision, Words
from regdb_compiler.documents.section import (
    Bounds,
    Case,
    Cases,
    Condition,
    Definition,
    Delegation,
    Expectation,
    LawTest,
    Omitted,
    Regulation,
    Section,
    Source,
    States,
    Vagueness,
    Version,
)

__all__ = [
    "Account", "Age", "Assumed", "Attribute", "Boolean", "Bounds", "Case", "Cases", "CitationStyle", "Condition", "Date",
    "Definition", "Delegation", "Document", "Expectation", "Fact", "Force", "Fusion", "Governs", "Integer", "Jurisdiction",
    "JurisdictionsFile", "LawTest", "Omitted", "Outline", "OutlineArticle", "OutlineChapter", "OutlineSection",
    "Plausible", "Raw", "Regulation", "Section", "Sections", "Slug", "Source", "State", "States", "StatesFile", "Subdivision",
    "SuperState", "Vagueness", "Version", "VocabularyFile", "Words",
]  # fmt: skip
