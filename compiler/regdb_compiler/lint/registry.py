"""Every lint rule: the shipped ones in an explicit tuple by family, and those of other packages by entry point."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from types import ModuleType

from regdb_compiler.lint.rule import Rule, RuleError, rule_of
from regdb_compiler.lint.rules import (
    authority_without_need,
    binds_always,
    boolean_compared,
    case_of_absent_section,
    checked_before_effective,
    checked_in_future,
    condition_says_nothing,
    constant_condition,
    contradictory_literals,
    copied_sentence,
    delegation_as_rule,
    delegation_to_nobody,
    double_negation,
    duplicate_literal,
    duplicate_regulation,
    duplicate_test_name,
    empty_text,
    empty_title,
    every_value_listed,
    exact_quantity,
    exception_elsewhere,
    expired_target,
    fact_without_interpretation,
    far_date,
    file_name_not_section,
    force_without_limit,
    id_not_from_subdivision,
    implausible_speed,
    impossible_limit,
    impossible_transition,
    judged_outside_version,
    judgement_without_interpretation,
    known_of_assumed,
    limit_said_twice,
    limit_without_force,
    local_rule_without_sign,
    location_spelled_otherwise,
    lonely_topic,
    lost_number,
    malformed_url,
    manoeuvre_without_states,
    near_duplicate_fact,
    never_together,
    no_final_line_feed,
    no_location,
    no_schema_line,
    not_yet_in_force,
    odd_subdivision,
    one_sided_confusable,
    one_sided_tests,
    or_of_negations,
    outline_contradicts_file,
    partial_section,
    penalty_tier_as_limit,
    permission_by_assumption,
    permission_from_permission,
    polarity_mismatch,
    prima_facie_called_absolute,
    quote_not_in_text,
    quote_with_gap,
    reason_without_score,
    recalled_source,
    redundant_override,
    redundant_subdivision,
    repeated_item,
    score_without_reason,
    section_listed_twice,
    section_not_in_text,
    section_not_quoted,
    shared_phrase,
    silent_subdivision,
    source_without_url,
    state_named_twice,
    subdivisions_out_of_order,
    tab_character,
    text_changed,
    trailing_space,
    unaccounted_section,
    uncited_subdivision,
    undeclared_confusable,
    unknown_confusable,
    unless_cancels_when,
    unless_repeats_when,
    unlisted_section,
    unreadable_bounds,
    unreadable_citation,
    unspoken_fact,
    untested_boundary,
    untested_exception,
    untested_regulation,
    unused_fact,
    unused_tag,
    vague_word_not_scored,
    verified_by_one_source,
    windows_line_end,
)

GROUP = "regdb.lint_rules"
"""Entry point group of third-party rules: each names a module that is a rule, or a list of such modules."""

MODULES: tuple[ModuleType, ...] = (
    # R0 syntax and schema
    section_not_quoted,
    # R1 identity, citation, source
    file_name_not_section,
    subdivisions_out_of_order,
    odd_subdivision,
    unreadable_citation,
    source_without_url,
    recalled_source,
    verified_by_one_source,
    checked_in_future,
    checked_before_effective,
    empty_title,
    no_location,
    location_spelled_otherwise,
    malformed_url,
    unlisted_section,
    unaccounted_section,
    partial_section,
    outline_contradicts_file,
    section_listed_twice,
    # R2 text and annotation
    copied_sentence,
    lost_number,
    condition_says_nothing,
    quote_not_in_text,
    polarity_mismatch,
    uncited_subdivision,
    binds_always,
    empty_text,
    quote_with_gap,
    text_changed,
    section_not_in_text,
    silent_subdivision,
    # R3 quantities
    limit_without_force,
    force_without_limit,
    implausible_speed,
    penalty_tier_as_limit,
    prima_facie_called_absolute,
    exact_quantity,
    limit_said_twice,
    impossible_limit,
    # R4 facts and states
    unused_fact,
    impossible_transition,
    every_value_listed,
    constant_condition,
    known_of_assumed,
    unknown_confusable,
    one_sided_confusable,
    manoeuvre_without_states,
    duplicate_literal,
    contradictory_literals,
    permission_by_assumption,
    double_negation,
    boolean_compared,
    undeclared_confusable,
    or_of_negations,
    unless_cancels_when,
    unless_repeats_when,
    state_named_twice,
    unspoken_fact,
    shared_phrase,
    # R5 time
    not_yet_in_force,
    expired_target,
    never_together,
    judged_outside_version,
    far_date,
    # R6 authority, exceptions, overrides
    delegation_as_rule,
    local_rule_without_sign,
    exception_elsewhere,
    permission_from_permission,
    redundant_override,
    authority_without_need,
    delegation_to_nobody,
    unreadable_bounds,
    # R7 vagueness and review
    vague_word_not_scored,
    score_without_reason,
    reason_without_score,
    fact_without_interpretation,
    judgement_without_interpretation,
    # R8 tests and coverage
    untested_regulation,
    one_sided_tests,
    untested_boundary,
    untested_exception,
    duplicate_test_name,
    case_of_absent_section,
    # R9 hygiene
    trailing_space,
    tab_character,
    lonely_topic,
    unused_tag,
    id_not_from_subdivision,
    duplicate_regulation,
    near_duplicate_fact,
    no_final_line_feed,
    windows_line_end,
    redundant_subdivision,
    repeated_item,
    no_schema_line,
)


@cache
def shipped_rules() -> tuple[Rule, ...]:
    """The rules of this package, by family and code."""
    return tuple(rule_of(module) for module in MODULES)


def all_rules(points: Iterable[EntryPoint] | None = None) -> tuple[Rule, ...]:
    """The shipped rules and those that installed packages add. Raises RuleError when a package's rule is none or takes a code."""
    found = list(shipped_rules())
    taken = {word: rule for rule in found for word in (rule.code, rule.name)}
    for point in sorted(entry_points(group=GROUP) if points is None else points, key=lambda item: (item.name, item.value)):
        for rule in _rules_of(point):
            clash = taken.get(rule.code) or taken.get(rule.name)
            if clash is not None:
                raise RuleError(f"{rule.origin} takes the code or name of {clash.origin}: {rule.code} {rule.name}")
            taken.update({rule.code: rule, rule.name: rule})
            found.append(rule)
    return tuple(found)


def _rules_of(point: EntryPoint) -> list[Rule]:
    try:
        loaded = point.load()
    except Exception as error:  # whatever a foreign package does, say whose it is
        raise RuleError(f"the lint rules of entry point `{point.name}` cannot be loaded: {type(error).__name__}: {error}") from error
    return [rule_of(module) for module in ([loaded] if isinstance(loaded, ModuleType) else loaded)]
