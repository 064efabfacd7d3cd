"""Time other planners on the work of bench/plan.py; run by the Python of their own environment, prints JSON. See bench/plan.py.

Reads a job as JSON from stdin: waypoints, start, end speeds, durations, offsets, points. Each rival that cannot be had is named with why.
"""

# ruff: noqa: T201, BLE001, FBT003  # a script whose result is what it prints; what a rival raises is its result; frenetix has no names
from __future__ import annotations

import json
import os
import sys
import time
import types
from collections.abc import Callable
from typing import Any

import numpy as np


def seconds(work: Callable[[], Any], rounds: int) -> float:
    """Processor seconds, the least of a few rounds."""
    work()
    times = []
    for _ in range(rounds):
        begun = time.process_time()
        work()
        times.append(time.process_time() - begun)
    return min(times)


def frenetix_plans(job: dict[str, Any]) -> dict[str, Any]:
    """Sampling, coordinates, five checks and four costs in C++; plus the plans of the check, to be compared."""
    import frenetix
    from frenetix import trajectory_functions as functions

    line = frenetix.CoordinateSystemWrapper(np.array(job["fine"]))
    s, v, a, d = job["start"]
    heading = float(np.interp(s, line.ref_pos, line.ref_theta))

    def handler() -> Any:
        made = frenetix.TrajectoryHandler(dt=0.1)
        made.add_function(functions.FillCoordinates(True, heading, line, 5.0))
        for check in (
            functions.feasability_functions.CheckYawRateConstraint(0.6, 2.8, False),
            functions.feasability_functions.CheckAccelerationConstraint(10.0, 8.0, False),
            functions.feasability_functions.CheckCurvatureConstraint(0.6, 2.8, False),
            functions.feasability_functions.CheckCurvatureRateConstraint(2.8, 0.4, False),
            functions.feasability_functions.CheckVelocityConstraint(False),
        ):
            made.add_feasability_function(check)
        costs = functions.cost_functions
        made.add_cost_function(costs.CalculateAccelerationCost("acceleration", 1.0))
        made.add_cost_function(costs.CalculateJerkCost("jerk", 1.0))
        made.add_cost_function(costs.CalculateDistanceToReferencePathCost("offset", 1.0))
        made.add_cost_function(costs.CalculateVelocityOffsetCost("speed", 1.0, 14.0, 0.1, 1.1, False, 2))
        return made

    def matrix(ends: list[float], durations: list[float], offsets: list[float]) -> np.ndarray:
        rows = [[0.0, t, s, v, a, end, 0.0, d, 0.0, 0.0, offset, 0.0, 0.0] for t in durations for end in ends for offset in offsets]
        return np.array(rows)

    sampled = matrix(job["ends"], job["durations"], job["offsets"])
    made = handler()

    def plan() -> None:
        made.reset_Trajectories()
        made.generate_trajectories(sampled, True)
        made.evaluate_all_current_functions(True)

    took = seconds(plan, job["rounds"])
    few = handler()
    few.generate_trajectories(matrix(job["check_ends"], [5.0], [d]), True)
    few.evaluate_all_current_functions(True)
    plans = [
        {"x": list(p.cartesian.x), "y": list(p.cartesian.y), "v": list(p.cartesian.v), "a": list(p.cartesian.a), "kappa": list(p.cartesian.kappa)}
        for p in few.get_sorted_trajectories()
    ]
    return {"seconds": took, "plans": len(sampled), "check": plans}


def python_robotics(job: dict[str, Any]) -> dict[str, Any]:
    """Its own lattice at its own step of 0.2 s, with its checks and its discs for road users."""
    sys.path.insert(0, os.path.join(job["python_robotics"], "PathPlanning"))  # noqa: PTH118
    sys.modules.setdefault("matplotlib", types.ModuleType("matplotlib"))
    sys.modules.setdefault("matplotlib.pyplot", types.ModuleType("matplotlib.pyplot"))
    from FrenetOptimalTrajectory import frenet_optimal_trajectory as planner

    points = np.array(job["waypoints"])
    spline = planner.cubic_spline_planner.CubicSpline2D(points[:, 0], points[:, 1])
    boxes = np.array(job["boxes"])
    s, v, a, d = job["start"]
    planner.TARGET_SPEED, planner.MAX_SPEED = 14.0, 30.0
    kept: list[int] = []

    def plan() -> None:
        _, found = planner.frenet_optimal_planning(spline, s, v, a, d, 0.0, 0.0, boxes)
        kept.append(sum(len(paths) for paths in found.values()))

    took = seconds(plan, 2)
    return {"seconds": took, "plans": kept[-1]}


def clcs_projection(job: dict[str, Any]) -> dict[str, Any]:
    """Points to curvilinear coordinates, one thread."""
    from commonroad_clcs.pycrccosy import CurvilinearCoordinateSystem

    system = CurvilinearCoordinateSystem([np.array(point) for point in job["fine"]], 25.0, 0.1)
    points = [np.array(point) for point in job["points"]]
    found: list[Any] = []

    def project() -> None:
        found[:] = system.convert_list_of_points_to_curvilinear_coords(points, 1)

    took = seconds(project, job["rounds"])
    first = float(system.convert_to_curvilinear_coords(*job["fine"][0])[0])  # it lengthens the line before its start
    return {"seconds": took, "points": len(points), "s": [float(p[0]) - first for p in found], "d": [float(p[1]) for p in found]}


def main() -> None:
    """Each rival, or why not."""
    job = json.load(sys.stdin)
    results: dict[str, Any] = {}
    for name, work in (("frenetix", frenetix_plans), ("PythonRobotics", python_robotics), ("commonroad-clcs", clcs_projection)):
        try:
            results[name] = work(job)
        except Exception as reason:
            results[name] = {"missing": f"{type(reason).__name__}: {reason}"}
    print(json.dumps(results))


if __name__ == "__main__":
    main()
