"""Numbers of the strategist: distances and times at which manoeuvres are offered, and what changing one's mind costs."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class StrategySettings:
    """All of it design, none of it law; SI.

    Speeds: `cruise_speed` is what the vehicle would drive on an empty road without limit (30 m/s, a freeway's flow); curves are taken with at most
    `lateral_acceleration` (2 m/s2, comfortable to passengers).
    """

    cruise_speed: float = 30.0
    lateral_acceleration: float = 2.0
    path_behind: float = 60.0
    """Metres of path kept behind the vehicle: tracks beside and behind it are placed on the same path."""
    path_ahead: float = 400.0
    """Metres of path built ahead: over 10 s at a freeway's speed, so a path is built once for many ticks."""
    path_needed: float = 200.0
    """Metres before a path's end from which on that end is something to stop at."""
    path_step: float = 25.0
    """Metres of driving after which a path is asked for anew: often enough that `path_needed` always remains."""

    handling_distance: float = 50.0
    handling_time: float = 8.0
    """Intersection handling begins at the greater of 50 m and 8 s before the line: a little before the stop there must be decided."""
    handling_hysteresis: float = 15.0
    """Metres farther than which it ends again when a line recedes (a change of lane); less would ping-pong."""
    decision_braking: float = 1.2
    """m/s2; stopping or entering is decided where this mean braking still reaches the line. The sampler's smooth stop peaks at 1.5 times the mean:
    1.8 m/s2, within the 2 m/s2 of comfort (and of the paper's speed figure)."""
    decision_time: float = 0.5
    """Seconds driven on before that braking begins: one strategic tick."""
    decision_margin: float = 3.0
    """Metres added to the decision's distance, so that a car that creeps up to the line also decides."""
    waiting_braking: float = 2.5
    """m/s2; what is not known about the junction (whether its far side is free, what a light shows) may come to be known until this is needed."""
    yellow_braking: float = 3.0
    """m/s2; on yellow the vehicle stops wherever this reaches the line (ITE's signal timing reckons with 10 ft/s2)."""
    yellow_stopping: float = 6.0
    """m/s2; a stop begun on yellow is given up only where not even this reaches the line any more."""

    stop_slack: float = 2.0
    """Metres short of the line within which a stop counts as at it (the paper's plateau, FEATURES H05)."""
    stop_margin: float = 0.5
    """Metres that the plan aims to stay short of the line."""
    stop_roll: float = 0.1
    """Metres that a vehicle slower than `standstill` may still roll: it does not creep on to the line from where it stopped."""
    standstill: float = 0.1
    """m/s below which the vehicle stands."""
    check_time: float = 1.0
    """Seconds stood at the line before the way is asked for: two strategic ticks in which signs and crossing traffic are looked at."""

    follow_time: float = 4.0
    follow_distance: float = 20.0
    """A vehicle ahead is followed within 20 m plus 4 s of own speed, and farther while the gap closes in less than `closing_time`."""
    closing_time: float = 8.0
    follow_hysteresis: float = 1.25
    """Once followed, it is until that many times farther away."""
    corridor_margin: float = 0.3
    """Metres beside the vehicle's width within which something ahead is in its way."""
    rider_margin: float = 1.0
    """The same for riders and walkers that go the same way: whoever would be passed nearer than that is followed or overtaken, not driven past."""

    slow_share: float = 0.75
    """Overtake what drives slower than this share of the own free speed."""
    least_gain: float = 2.0
    """m/s; and only when that is this much faster."""
    overtake_distance: float = 60.0
    overtake_time: float = 6.5
    """Passing is thought of within 60 m or 6.5 s of what is slow, whichever is more: before it need be followed."""
    return_gap: float = 6.0
    """Metres between the rear bumper and what was passed before the vehicle goes back in lane."""
    return_time: float = 1.0
    """Seconds of the passed one's speed added to that."""
    finish_margin: float = 20.0
    """Metres that must remain between the end of a pass and the next line, junction or needed change of lane."""
    pass_clearances: tuple[float, ...] = (1.0, 1.25, 1.5, 2.0)
    """Metres edge to edge that in-lane passes aim at: from what most laws ask (3 ft is 0.91 m) to what handbooks advise (1.5 m) and beyond."""
    edge_margin: float = 0.02
    """Metres kept to the lane's boundary by the widest in-lane pass: the width of tracking and tabulation errors."""
    aim_beyond: float = 0.05
    """Metres beyond an offset's clearance, so that rounding does not eat what law asks."""

    settled_offset: float = 0.3
    """Metres from a lane's centre within which a change of lane is over."""
    lane_change_distance: float = 250.0
    """Metres before the place where the route needs another lane in which the change is sought: 15 s at 35 mph."""
    lane_change_length: float = 60.0
    """Metres a change takes with its signalling, kept free before a junction."""
    lane_change_gap_ahead: float = 8.0
    lane_change_gap_behind: float = 6.0
    """Metres to others in the target lane below which no change is begun; what is safe beyond that, law and prediction decide."""

    stands_beside: float = 3.7
    """Metres from the lane's edge (a lane's width, 12 ft) within which a vehicle that stands with its warning lights on is given room by a change of
    lane, where there is one; whether that is a duty, the law says."""
    give_room: float = 10.0
    """What that change is worth: courtesy where it is no duty."""
    open_gap: float = 2.0
    """m/s by which the vehicle goes slower than who keeps it from a change of lane that the route needs."""
    reroute_distance: float = 25.0
    """Metres before a junction at which a change of lane that has not come about is given up for another route, from the lane that is driven in."""

    need_lane: float = 40.0
    """Metres of advance (the unit of all that follows): what a change of lane that the route needs is worth at last; a quarter at first."""
    lane_change_cost: float = 2.0
    """What passing by another lane costs over passing within the lane. Its preparation, no faster than following, is credited with all the rest."""
    patience: float = 8.0
    """Seconds for which a pass by another lane stays prepared while that lane is taken; begun is it only where the change could be made now."""
    move: float = 30.0
    """Making a change of lane rather than going on preparing it: what its offsets cost by the default profile, and a little more."""
    return_to_lane: float = 8.0
    """Going back to the right once something has been passed."""
    switch: float = 0.5
    """Changing state: two candidates nearer than this do not take turns."""
    abandon: float = 60.0
    """Giving up a change of lane or a pass under way, or entering again what was just left."""
    least_dwell: float = 1.0
    """Seconds before a state that was left by choice is entered again without that cost."""

    easing_time: float = 1.0
    """Seconds of slowing down without new speed after an emergency, before the lane is followed again: two strategic ticks."""
