"""The layout of one robot: its panels with their topics, services and parameters.

Source: docs/spec/foxglove.md sections 3 and 4.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

from thymio_sim_ros.studio_layout.panels import Node, Panel, Split, Tabs

__all__ = ["Names", "describe"]

_PROXIMITY = ("left", "center_left", "center", "center_right", "right", "rear_left", "rear_right")
_COLORS = ("#4e98e2", "#f5774d", "#f7df71", "#5cd6a9", "#a395e2", "#df9bd9", "#808080")
_BUTTONS = ("forward", "left", "center", "right", "backward")
_GREEN, _GRAY = "#68e24a", "#a0a0a0"
_HIDDEN = {"visible": False}

# Speeds of the teleop panel: half of the largest speed of a Thymio, and one revolution in six seconds.
_SPEED_M_S, _TURN_RAD_S, _TELEOP_HZ = 0.1, 1.0, 10
_WINDOW_S = 20

_FRAMES = (
    "odom",
    "base_link",
    "base_footprint",
    "left_wheel_link",
    "right_wheel_link",
    "laser_link",
    "base_scan",
    "ground_left_link",
    "ground_right_link",
    *(f"proximity_{name}_link" for name in _PROXIMITY),
)
"""Frames that are not shown: their axes would hide the robot."""


class Names:
    """Names of one robot in a suite; `robot` is empty if it is the only one, `namespace` is that of the suite."""

    def __init__(self, robot: str = "", namespace: str = "") -> None:
        self._prefix = f"{robot}/" if robot else ""
        self._namespace = f"/{namespace}" if namespace else ""

    def of_world(self, name: str) -> str:
        """Absolute name of a topic or service of the suite as a whole."""
        return f"{self._namespace}/{name}"

    def topic(self, name: str) -> str:
        """Absolute name of a topic or service of the robot."""
        return self.of_world(f"{self._prefix}{name}")

    def frame(self, name: str) -> str:
        """Frame name."""
        return f"{self._prefix}{name}"


def describe(robot: str = "", namespace: str = "") -> Node:
    """The whole layout; `robot` is empty for the only robot of a playground, `namespace` is that of the suite."""
    names = Names(robot, namespace)
    left = Split("column", ((62, _scene(names)), (38, _drive(names))))
    tabs = Tabs(
        "details",
        (
            ("Sensors", _sensors(names)),
            ("Lights", _lights(names)),
            ("Program", _program(names)),
            ("Parameters", Panel("Parameters", "parameters", "Parameters")),
            ("Health", _health()),
            ("Graph", Panel("TopicGraph", "graph", "Topic graph")),
        ),
    )
    return Split("row", ((55, left), (45, tabs)))


def _scene(names: Names) -> Panel:
    shown = (
        names.of_world("_markers"),
        names.of_world("_markers/objects"),
        names.topic("_pen/trail"),
        names.topic("_proximity/rays"),
        names.topic("scan"),
    )
    return Panel(
        "3D",
        "scene",
        "Playground",
        {
            "followTf": names.frame("base_link"),
            "followMode": "follow-position",
            "cameraState": {
                "perspective": True,
                "distance": 1.0,
                "phi": 45.0,
                "thetaOffset": 0.0,
                "target": [0.0, 0.0, 0.0],
                "targetOffset": [0.0, 0.0, 0.0],
                "targetOrientation": [0.0, 0.0, 0.0, 1.0],
                "fovy": 45.0,
                "near": 0.01,
                "far": 50.0,
            },
            "scene": {"meshUpAxis": "z_up", "transforms": {"axisScale": 0.1, "showLabel": False}},
            "transforms": {f"frame:{names.frame(frame)}": _HIDDEN for frame in _FRAMES},
            "topics": {topic: {"visible": True} for topic in shown},
            "layers": {
                "robot": {
                    "layerId": "foxglove.Urdf",
                    "instanceId": "robot",
                    "label": "Robot",
                    "sourceType": "topic",
                    "topic": names.topic("robot_description"),
                    "framePrefix": "",
                    "displayMode": "auto",
                    "visible": True,
                    "order": 1,
                },
            },
        },
    )


def _drive(names: Names) -> Node:
    teleop = Panel(
        "Teleop",
        "teleop",
        "Drive",
        {
            "topic": names.topic("cmd_vel"),
            "publishRate": _TELEOP_HZ,
            "upButton": {"field": "linear-x", "value": _SPEED_M_S},
            "downButton": {"field": "linear-x", "value": -_SPEED_M_S},
            "leftButton": {"field": "angular-z", "value": _TURN_RAD_S},
            "rightButton": {"field": "angular-z", "value": -_TURN_RAD_S},
        },
        {"stopButton": {"field": "linear-x", "value": 0}, "autoSendStopOnRelease": True},
    )
    world = Tabs(
        "world",
        (
            ("Reset", _call("world-reset", names.of_world("simulator/reset"), "Begin again")),
            ("Pause", _call("world-pause", names.of_world("simulator/pause"), "Stop the clock", {"data": True})),
            ("Go on", _call("world-go", names.of_world("simulator/pause"), "Start the clock", {"data": False})),
            ("Step", _call("world-step", names.of_world("simulator/step"), "One step")),
        ),
    )
    return Split("row", ((50, teleop), (50, world)))


def _sensors(names: Names) -> Node:
    proximity = _plot(
        "proximity",
        "Proximity (m)",
        ((name.replace("_", " "), f"{names.topic(f'proximity/{name}')}.range") for name in _PROXIMITY),
        low=0.0,
        high=0.15,
    )
    ground = _plot(
        "ground",
        "Ground (reflected light)",
        # Words 4 and 5 of the ground sensors are what Aseba calls prox.ground.delta.
        ((side, f"{names.topic('_raw/ground')}.data[{4 + index}]") for index, side in enumerate(("left", "right"))),
        low=0.0,
        high=1100.0,
    )
    buttons = _row(tuple(_button(names, name) for name in _BUTTONS))
    return Split("column", ((45, proximity), (35, ground), (20, buttons)))


def _lights(names: Names) -> Node:
    color = "std_msgs/msg/ColorRGBA"
    rows = (
        ("led/body/top", "Top", (("red", (1, 0, 0)), ("green", (0, 1, 0)), ("blue", (0, 0, 1)))),
        ("led/body/bottom_left", "Bottom left", (("cyan", (0, 1, 1)), ("off", (0, 0, 0)))),
        ("led/body/bottom_right", "Bottom right", (("magenta", (1, 0, 1)), ("off", (0, 0, 0)))),
    )
    lines: list[Node] = []
    for topic, what, shades in rows:
        line = []
        for shade, (red, green, blue) in shades:
            value = {"r": red, "g": green, "b": blue, "a": 1}
            key = f"{topic.replace('/', '-')}-{shade}"
            line.append(_publish(key, names.topic(topic), color, f"{what} {shade}", value))
        lines.append(_row(tuple(line)))
    circle = {"layout": {"dim": [], "data_offset": 0}, "data": [1, 0, 0.5, 0, 1, 0, 0.5, 0]}
    lines.append(
        _row(
            (
                _publish("circle", names.topic("led/circle"), "std_msgs/msg/Float32MultiArray", "Circle", circle),
                _publish("lights-off", names.topic("_led/off"), "std_msgs/msg/Empty", "All lights off", {}),
            )
        )
    )
    state = _raw("lights", "Lights (levels)", f"{names.topic('_led/state')}.data")
    return Split("column", (*((14.0, line) for line in lines), (44.0, state)))


def _program(names: Names) -> Node:
    control = Tabs(
        "control",
        tuple(
            (word.capitalize(), _call(f"program-{word}", names.topic(f"aseba/{word}"), word.capitalize()))
            for word in ("run", "pause", "step", "stop", "reset")
        ),
    )
    status = _raw("status", "Program", names.topic("_aseba/status"))
    variables = _raw("variables", "Variables", names.topic("_aseba/variables"))
    events = _raw("events", "Events", names.topic("_aseba/events"))
    looks = Tabs("looks", (("State", status), ("Variables", variables), ("Events", events)))
    return Split("column", ((55, looks), (45, control)))


def _health() -> Node:
    diagnostics = Panel(
        "DiagnosticSummary",
        "diagnostics",
        "Diagnostics",
        {"topicToRender": "/diagnostics", "minLevel": 0, "pinnedIds": [], "hardwareIdFilter": "", "sortByLevel": True},
    )
    log = Panel("RosOut", "log", "Log", {"topicToRender": "/rosout", "minLogLevel": 1, "searchTerms": []})
    return Split("column", ((40, diagnostics), (60, log)))


def _plot(key: str, title: str, series: Iterable[tuple[str, str]], *, low: float, high: float) -> Panel:
    paths = [
        {
            "value": path,
            "label": label,
            "enabled": True,
            "color": color,
            "timestampMethod": "receiveTime",
            "showLine": True,
        }
        for (label, path), color in zip(series, _COLORS, strict=False)
    ]
    return Panel(
        "Plot",
        key,
        title,
        {
            "paths": paths,
            "minYValue": low,
            "maxYValue": high,
            "showLegend": True,
            "legendDisplay": "left",
            "showPlotValuesInLegend": True,
            "showXAxisLabels": True,
            "showYAxisLabels": True,
            "isSynced": True,
            "xAxisVal": "timestamp",
            "followingViewWidth": _WINDOW_S,
            "sidebarDimension": 210,
        },
    )


def _button(names: Names, name: str) -> Panel:
    rules = [{"operator": "=", "rawValue": "true", "color": _GREEN, "label": name}]
    config = {
        "path": f"{names.topic(f'buttons/{name}')}.data",
        "style": "bulb",
        "fallbackColor": _GRAY,
        "fallbackLabel": name,
        "rules": rules,
    }
    return Panel("Indicator", f"button-{name}", name.capitalize(), config)


def _publish(key: str, topic: str, datatype: str, text: str, value: Any) -> Panel:
    config = {
        "topicName": topic,
        "datatype": datatype,
        "buttonText": text,
        "buttonTooltip": topic,
        "advancedView": False,
        "value": json.dumps(value),
    }
    return Panel("Publish", key, text, config)


def _call(key: str, service: str, text: str, request: Any = None) -> Panel:
    config = {
        "serviceName": service,
        "requestPayload": json.dumps(request or {}),
        "buttonText": text,
        "layout": "vertical",
    }
    return Panel("CallService", key, text, config)


def _raw(key: str, title: str, path: str) -> Panel:
    config = {
        "topicPath": path,
        "diffEnabled": False,
        "diffMethod": "custom",
        "diffTopicPath": "",
        "showFullMessageForDiff": False,
        "expansion": "all",
    }
    return Panel("RawMessages", key, title, config)


def _row(panels: tuple[Node, ...]) -> Split:
    return Split("row", tuple((100 / len(panels), panel) for panel in panels))
