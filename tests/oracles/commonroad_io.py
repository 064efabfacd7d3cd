"""Dumps CommonRoad files as commonroad-io reads them, one JSON object per file; runs in an environment of its own, never in the project's.

python commonroad_io.py FILE... > dump.json
"""

import json
import logging
import sys
import warnings

logging.disable(logging.CRITICAL)
warnings.simplefilter("ignore")

from commonroad.common.file_reader import CommonRoadFileReader  # noqa: E402
from commonroad.scenario.obstacle import StaticObstacle  # noqa: E402


def points(array):
    return [[float(x), float(y)] for x, y, *_ in array]


def names(ids):
    return sorted(str(one) for one in ids or ())


def words(values):
    return sorted(value.value for value in values or ())


def stop_line(line):
    if line is None:
        return None
    return {
        "start": points([line.start])[0], "end": points([line.end])[0], "marking": line.line_marking.value,
        "lights": names(line.traffic_light_ref), "signs": names(line.traffic_sign_ref),
    }  # fmt: skip


def limit(item, network):
    """The least speed that the lane's signs print; the library's own interpreter knows the signs of some countries alone."""
    plates = [plate for ref in item.traffic_signs for plate in network.find_traffic_sign_by_id(ref).traffic_sign_elements]
    speeds = [float(plate.additional_values[0]) for plate in plates if plate.traffic_sign_element_id.name == "MAX_SPEED"]
    return min(speeds, default=None)


def lane(item, network):
    return {
        "left": points(item.left_vertices), "right": points(item.right_vertices), "center": points(item.center_vertices),
        "predecessors": names(item.predecessor), "successors": names(item.successor),
        "adjacent_left": None if item.adj_left is None else str(item.adj_left), "left_same": item.adj_left_same_direction,
        "adjacent_right": None if item.adj_right is None else str(item.adj_right), "right_same": item.adj_right_same_direction,
        "left_marking": item.line_marking_left_vertices.value, "right_marking": item.line_marking_right_vertices.value,
        "kinds": words(item.lanelet_type), "users": words(item.user_one_way), "both_ways": words(item.user_bidirectional),
        "signs": names(item.traffic_signs), "lights": names(item.traffic_lights), "stop_line": stop_line(item.stop_line),
        "limit": limit(item, network),
    }  # fmt: skip


def sign(item):
    return {
        "position": None if item.position is None else points([item.position])[0],
        "plates": [
            [plate.traffic_sign_element_id.value, plate.traffic_sign_element_id.name, [str(value) for value in plate.additional_values]]
            for plate in item.traffic_sign_elements
        ],
    }


def light(item):
    cycle = item.traffic_light_cycle
    return {
        "position": None if item.position is None else points([item.position])[0], "direction": item.direction.value, "active": bool(item.active),
        "cycle": [[part.state.value, part.duration] for part in cycle.cycle_elements], "offset": cycle.time_offset,
    }  # fmt: skip


def intersection(item):
    return [
        {
            "id": str(part.incoming_id), "lanes": names(part.incoming_lanelets), "right": names(part.outgoing_right),
            "straight": names(part.outgoing_straight), "left": names(part.outgoing_left),
        }
        for part in item.incomings
    ]  # fmt: skip


def state(obstacle, one):
    middle = obstacle.obstacle_shape.compute_occupancy_for_state(one).rect_center
    acceleration = getattr(one, "acceleration", None)
    return [
        int(one.time_step), float(middle.x), float(middle.y), float(one.orientation),
        float(one.velocity), None if acceleration is None else float(acceleration),
    ]  # fmt: skip


def obstacle(item):
    states = [item.initial_state]
    prediction = getattr(item, "prediction", None)
    if prediction is not None:
        states += prediction.trajectory.state_list
    shape = item.obstacle_shape
    return {
        "type": item.obstacle_type.value, "static": isinstance(item, StaticObstacle), "length": float(shape.length), "width": float(shape.width),
        "states": [state(item, one) for one in states],
    }  # fmt: skip


def dump(path):
    scenario, problems = CommonRoadFileReader(path).open()
    network = scenario.lanelet_network
    return {
        "time_step": scenario.dt,
        "lanes": {str(item.lanelet_id): lane(item, network) for item in network.lanelets},
        "signs": {str(item.traffic_sign_id): sign(item) for item in network.traffic_signs},
        "lights": {str(item.traffic_light_id): light(item) for item in network.traffic_lights},
        "intersections": {str(item.intersection_id): intersection(item) for item in network.intersections},
        "obstacles": {str(item.obstacle_id): obstacle(item) for item in scenario.obstacles},
        "problems": {
            str(name): [one.time_step, *points([one.position])[0], one.orientation, one.velocity]
            for name, one in ((name, item.initial_state) for name, item in problems.planning_problem_dict.items())
        },
    }  # fmt: skip


json.dump({path: dump(path) for path in sys.argv[1:]}, sys.stdout)
