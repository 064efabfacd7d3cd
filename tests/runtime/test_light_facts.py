"""Lights and what they say to a movement: arrows before circular lights, the stricter of two, unseen is unknown."""

import pytest
from regdb_runtime.maps.road_map import Light
from regdb_runtime.observation import Indication
from regdb_runtime.scenes.light_facts import light_facts

MAIN, ARROW = Light("main"), Light("arrow", direction="right", arrow=True)


def shown(*indications: Indication, turn: str = "straight") -> dict[str, object]:
    return dict(light_facts([MAIN], {"main": indications}, turn))  # type: ignore[arg-type]


@pytest.mark.parametrize("color", ["red", "yellow", "green"])
def test_a_circular_light_governs_every_movement(color: str) -> None:
    for turn in ("straight", "left", "right", "u_turn"):
        facts = shown(Indication(color), turn=turn)  # type: ignore[arg-type]
        assert (facts["signal.color"], facts["signal.shape"], facts["signal.flashing"]) == (color, "circular", False)
        assert facts["signal.inoperative"] is False


def test_an_arrow_governs_its_movement_and_no_other() -> None:
    both = Indication("red"), Indication("green", "right_arrow")
    right, straight = shown(*both, turn="right"), shown(*both, turn="straight")
    assert (right["signal.color"], right["signal.shape"]) == ("green", "arrow")
    assert (straight["signal.color"], straight["signal.shape"]) == ("red", "circular")
    assert right["signal.green_arrow_elsewhere"] is False
    assert straight["signal.green_arrow_elsewhere"] is True


def test_a_green_arrow_elsewhere_forbids_only_where_nothing_permits() -> None:
    assert shown(Indication("green"), Indication("green", "left_arrow"))["signal.green_arrow_elsewhere"] is False
    alone = shown(Indication("green", "left_arrow"))
    assert alone["signal.color"] == "none"
    assert alone["signal.green_arrow_elsewhere"] is True


def test_a_u_turn_goes_by_its_own_arrow_else_by_the_left_one() -> None:
    assert shown(Indication("green", "left_arrow"), Indication("red", "u_arrow"), turn="u_turn")["signal.color"] == "red"
    assert shown(Indication("green", "left_arrow"), turn="u_turn")["signal.color"] == "green"


def test_flashing_and_the_yellow_arrow() -> None:
    assert shown(Indication("red", flashing=True))["signal.flashing"] is True
    left = shown(Indication("yellow", "left_arrow", flashing=True), turn="left")
    assert left["signal.yields_on_arrow"] is True
    assert shown(Indication("yellow", flashing=True))["signal.yields_on_arrow"] is False


def test_a_dark_signal_does_not_work() -> None:
    facts = shown(Indication("dark"))
    assert facts["signal.inoperative"] is True
    assert facts["signal.color"] == "none"


def test_what_is_not_seen_or_not_recognised_is_unknown() -> None:
    assert light_facts([MAIN], {}, "straight") == {}
    unsure = shown(Indication("unknown"))
    assert "signal.color" not in unsure
    assert "signal.shape" not in unsure


def test_of_two_lights_for_one_movement_the_stricter_is_obeyed() -> None:
    other = Light("other")
    facts = light_facts([MAIN, other], {"main": (Indication("green"),), "other": (Indication("red"),)}, "straight")
    assert facts["signal.color"] == "red"
    assert light_facts([MAIN, other], {"main": (Indication("green"),)}, "straight")["signal.color"] == "green"


def test_a_light_that_the_map_has_as_an_arrow_shows_an_arrow() -> None:
    facts = light_facts([ARROW], {"arrow": (Indication("red"),)}, "right")
    assert (facts["signal.color"], facts["signal.shape"]) == ("red", "arrow")
