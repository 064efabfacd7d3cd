"""The planner behind ROS 2 messages: the fields of `nav_msgs/Odometry`, `autoware_perception_msgs/PredictedObjects` and
`TrafficLightGroupArray` in, those of `autoware_planning_msgs/Trajectory` out.

Nothing of ROS is imported: messages in are anything with these fields, as attributes (rclpy's) or keys (rosbridge's JSON); messages out are
plain dictionaries with the fields' own names, which `rosidl_runtime_py.set_message_fields(message, fields)` writes into a real one.
"""

from __future__ import annotations

import datetime
import math
from collections.abc import Iterable, Mapping
from typing import Any

from regdb.vocabulary import Value
from regdb_runtime.decision import Decision
from regdb_runtime.observation import Color, EgoState, Footprint, Indication, Observation, Provenance, Shape, Track, TrackKind, TurnSignal

KINDS: Mapping[int, TrackKind] = {0: "obstacle", 1: "car", 2: "truck", 3: "bus", 4: "truck", 5: "motorcycle", 6: "bicycle", 7: "pedestrian"}
"""`ObjectClassification`: unknown, car, truck, bus, trailer, motorcycle, bicycle, pedestrian."""
COLORS: Mapping[int, Color] = {0: "unknown", 1: "red", 2: "yellow", 3: "green"}
"""`TrafficLightElement.color`; white (4) means nothing to road traffic."""
SHAPES: Mapping[int, Shape] = {1: "circular", 2: "left_arrow", 3: "right_arrow", 4: "straight_arrow"}
"""`TrafficLightElement.shape` as far as the law speaks of it."""
OFF, FLASHING = 1, 3
"""`TrafficLightElement.status`."""
TURN_INDICATORS: Mapping[TurnSignal, int] = {"off": 1, "left": 2, "right": 3, "hazard": 1}
"""`autoware_vehicle_msgs/TurnIndicatorsCommand.command`: disable, left, right."""


def field(message: Any, path: str) -> Any:
    """A field by its dotted path, from attributes or keys. Raises KeyError or AttributeError for one that is not there."""
    for name in path.split("."):
        message = message[name] if isinstance(message, Mapping) else getattr(message, name)
    return message


def seconds(stamp: Any) -> float:
    """A `builtin_interfaces/Time` in seconds."""
    return float(field(stamp, "sec")) + float(field(stamp, "nanosec")) * 1e-9


def yaw(quaternion: Any) -> float:
    """Heading of a `geometry_msgs/Quaternion` in radians."""
    x, y, z, w = (float(field(quaternion, name)) for name in "xyzw")
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def quaternion(heading: float) -> dict[str, float]:
    """A heading as `geometry_msgs/Quaternion`."""
    return {"x": 0.0, "y": 0.0, "z": math.sin(heading / 2), "w": math.cos(heading / 2)}


def ego_state(odometry: Any, acceleration: Any | None = None, turn_signal: TurnSignal = "off") -> EgoState:
    """The vehicle from `nav_msgs/Odometry`, whose child frame is `base_link`: the middle of the rear axle. `acceleration`:
    `geometry_msgs/AccelWithCovarianceStamped`. A vehicle that rolls backwards stands still for the planner."""
    pose, twist = field(odometry, "pose.pose"), field(odometry, "twist.twist")
    speed, rate = float(field(twist, "linear.x")), float(field(twist, "angular.z"))
    along = 0.0 if acceleration is None else float(field(acceleration, "accel.accel.linear.x"))
    curvature = rate / speed if abs(speed) > 0.5 else 0.0
    return EgoState(
        float(field(pose, "position.x")), float(field(pose, "position.y")), yaw(field(pose, "orientation")), max(speed, 0.0), along, curvature,
        turn_signal,
    )  # fmt: skip


def tracks(objects: Any) -> tuple[Track, ...]:
    """Road users from `PredictedObjects`: the likeliest class of each, its rectangle, its speed along its heading."""
    return tuple(_track(item) for item in field(objects, "objects"))


def _track(item: Any) -> Track:
    classes = [(float(field(guess, "probability")), -int(field(guess, "label"))) for guess in field(item, "classification")]
    label = -max(classes)[1] if classes else 0
    pose = field(item, "kinematics.initial_pose_with_covariance.pose")
    twist = field(item, "kinematics.initial_twist_with_covariance.twist")
    along, across = float(field(twist, "linear.x")), float(field(twist, "linear.y"))
    heading = yaw(field(pose, "orientation"))
    if along < 0:
        heading, along = math.remainder(heading + math.pi, math.tau), -along
    name = bytes(field(item, "object_id.uuid")).hex()
    size = field(item, "shape.dimensions")
    return Track(
        name, KINDS.get(label, "obstacle"), float(field(pose, "position.x")), float(field(pose, "position.y")), heading,
        math.hypot(along, across), float(field(size, "x")), float(field(size, "y")), yaw_rate=float(field(twist, "angular.z")),
    )  # fmt: skip


def signals(groups: Any, lights_of: Mapping[int, Iterable[str]]) -> dict[str, tuple[Indication, ...]]:
    """Lights from `TrafficLightGroupArray`; `lights_of`: group id (a regulatory element of the Lanelet2 map) -> ids of our map's lights.

    A group without elements was not seen: its lights are left out, so their colour is unknown.
    """
    found: dict[str, tuple[Indication, ...]] = {}
    for group in field(groups, "traffic_light_groups"):
        shown = tuple(_indication(element) for element in field(group, "elements") if int(field(element, "shape")) in SHAPES)
        for name in lights_of.get(int(field(group, "traffic_light_group_id")), ()) if shown else ():
            found[name] = shown
    return found


def _indication(element: Any) -> Indication:
    status = int(field(element, "status"))
    color = "dark" if status == OFF else COLORS.get(int(field(element, "color")), "unknown")
    return Indication(color, SHAPES[int(field(element, "shape"))], status == FLASHING)


def observation(
    odometry: Any, objects: Any, groups: Any, lights_of: Mapping[int, Iterable[str]], start: float, zone: datetime.tzinfo, *,
    acceleration: Any | None = None, turn_signal: TurnSignal = "off", facts: Mapping[str, Value] | None = None,
    silent: frozenset[str] = frozenset(), provenance: Provenance = "none",
) -> Observation:  # fmt: skip
    """One observation, of the odometry's own stamp. `start`: the stamp, in seconds, at which the run began; `zone`: the place's time zone."""
    stamp = seconds(field(odometry, "header.stamp"))
    clock = datetime.datetime.fromtimestamp(stamp, zone)
    ego = ego_state(odometry, acceleration, turn_signal)
    return Observation(stamp - start, clock, ego, tracks(objects), signals(groups, lights_of), facts or {}, silent, provenance)


def trajectory_fields(decision: Decision, stamp: Any, footprint: Footprint, frame: str = "map") -> dict[str, Any]:
    """The plan as the fields of `autoware_planning_msgs/Trajectory`; poses are those of `base_link`, the middle of the rear axle."""
    plan = decision.trajectory
    points = [
        {
            "time_from_start": duration(float(plan.time[k])),
            "pose": {
                "position": {"x": float(plan.x[k]), "y": float(plan.y[k]), "z": 0.0},
                "orientation": quaternion(float(plan.heading[k])),
            },
            "longitudinal_velocity_mps": float(plan.speed[k]),
            "lateral_velocity_mps": 0.0,
            "acceleration_mps2": float(plan.acceleration[k]),
            "heading_rate_rps": float(plan.speed[k] * plan.curvature[k]),
            "front_wheel_angle_rad": math.atan(footprint.wheelbase * float(plan.curvature[k])),
            "rear_wheel_angle_rad": 0.0,
        }
        for k in range(len(plan.time))
    ]
    at = {"sec": int(field(stamp, "sec")), "nanosec": int(field(stamp, "nanosec"))}
    return {"header": {"stamp": at, "frame_id": frame}, "points": points}


def duration(time: float) -> dict[str, int]:
    """Seconds as `builtin_interfaces/Duration`."""
    nanoseconds = round(time * 1e9)
    return {"sec": nanoseconds // 10**9, "nanosec": nanoseconds % 10**9}


def turn_indicators_fields(decision: Decision, stamp: Any) -> dict[str, Any]:
    """The turn signal as the fields of `autoware_vehicle_msgs/TurnIndicatorsCommand`."""
    at = {"sec": int(field(stamp, "sec")), "nanosec": int(field(stamp, "nanosec"))}
    return {"stamp": at, "command": TURN_INDICATORS[decision.turn_signal]}


def diagnostic_fields(decision: Decision, stamp: Any, name: str = "regdb") -> dict[str, Any]:
    """Why, as the fields of `diagnostic_msgs/DiagnosticArray`: state, flag, emergency gap, the chosen plan's verdict and sections."""
    chosen = None if decision.chosen is None else decision.candidates[decision.chosen]
    verdict = None if chosen is None else chosen.verdict
    level = 2 if decision.flag in {"emergency", "least_violation", "no_trajectory"} else 1 if decision.flag else 0
    values = {
        "state": decision.state, "stop_phase": decision.stop_phase, "flag": decision.flag,
        "verdict": "" if verdict is None else verdict.verdict,
        "sections": "" if verdict is None else "; ".join(rule.citation for rule in verdict.deciding),
        "emergency_gap": "" if decision.emergency.gap is None else f"{decision.emergency.gap:.2f} m",
        "events": "; ".join(decision.events),
    }  # fmt: skip
    pairs = [{"key": key, "value": value} for key, value in values.items()]
    at = {"sec": int(field(stamp, "sec")), "nanosec": int(field(stamp, "nanosec"))}
    status = {"level": level, "name": name, "message": decision.reason or decision.state, "hardware_id": "", "values": pairs}
    return {"header": {"stamp": at, "frame_id": ""}, "status": [status]}
