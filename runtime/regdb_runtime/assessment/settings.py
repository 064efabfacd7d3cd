"""Numbers of the assessment: how finely plans are measured, what counts as slowing, and which violations are the lesser ones."""

from __future__ import annotations

from dataclasses import dataclass

from regdb_runtime.planning.duties import DUTIES, Duty


@dataclass(frozen=True, slots=True)
class AssessmentSettings:
    """How plans are measured and ranked; SI. All of it design, none of it law."""

    decimals: int = 6
    """Measured numbers are rounded to a micrometre (per second): less than any rounding of the sampler's, more than floating point's."""
    line_tolerance: float = 0.01
    """Metres past a line or over a marking that still count as on it; below the 0.02 m that the strategist keeps to a lane's boundary."""
    standstill: float = 0.1
    """m/s below which the vehicle stands (the plateau of the paper's figure)."""
    slows_by: float = 0.5
    """m/s below the present speed from which a plan reduces speed; the resolution of a speedometer."""
    sudden_braking: float = 3.4
    """m/s2 from which braking is sudden: what AASHTO takes most drivers to find comfortable on wet roads (stopping sight distance)."""
    sensing_range: float = 100.0
    """Metres of road ahead taken to be seen where nothing says less; the range within which the vocabulary lets perception be relied on."""
    passing_range: float = 6.0
    """Metres edge to edge beyond which going by somebody is no overtaking of him: more than a lane and a half."""
    response: float = 2.0
    """Seconds after which a gap that is too small from the first must not be smaller still: a second to respond, one to brake in."""
    recovery: float = 1.0
    """Metres by which such a gap must have grown, measured by what is needed, when the plan ends."""
    crawl: float = 1.0
    """m/s below which the vehicle all but stands, and nothing more can be asked of it."""
    claims_no_room: bool = False
    """Whether plans claim that no path leaves the clearance the law asks. The claim opens an exception (CVC 21760(d)); waiting behind needs none."""
    duties: tuple[Duty, ...] = DUTIES
    """Duties from the weightiest; where nothing is lawful the plan is taken that breaks the weightier ones least."""
    breach_step: float = 0.1
    """How far beyond a limit counts in steps of this share of it: whether 3 or 8 percent on average is for comfort and safety to weigh, not a
    reason to brake with all there is."""
    first_batch: int = 1
    batch_growth: int = 8
    """Plans are judged in the order of cost, first this many at once, then so many times more: mostly the cheapest is lawful."""
