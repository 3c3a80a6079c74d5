"""Aseba's XML playgrounds, as data of our format (docs/spec/playground-formats.md section 1).

Centimeters and radians, the origin at the lower left corner of the world. Elements are read by groups, so that an
activation may name a door that comes later. What the simulator takes for granted is kept: missing numbers are 0,
unknown elements are passed over. A number that is none is refused here, where Aseba would read 0.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator

from thymio_sim_ros.sim.formats.xml_tree import Element
from thymio_sim_ros.sim.model.fields import LANGUAGE, FieldError
from thymio_sim_ros.sim.playground.importers import Conversion
from thymio_sim_ros.sim.playground.importers.names import Names, rounded, turned

__all__ = ["convert"]

ROOT = "aseba-playground"
WALL_M = 0.02
"""Thickness of the walls round the world; the format has none, their inner faces are its border."""
WALL_HEIGHT_M = 0.1
"""The format's are as high as it takes."""
LEAST_MOVE_S = 0.01
"""A door that opens at once."""
KG_PER_MASS = 0.27 / 200
"""Aseba's masses have no unit; there the robot has 200 (docs/spec/thymio-robot.md section 1)."""
LEAST_MASS_KG, MOST_MASS_KG = 0.001, 1000.0
LEAST_HEIGHT_M = 0.001
"""Of a thing without a height: it stands in the way and is not seen."""
DEFAULT_COLOR = "#808080"
"""Of things whose color is not declared: the format does not say which it is."""

_THYMIO = "thymio2"
_ROBOTS = ("robot", _THYMIO, "e-puck", "epuck")
"""Elements of robots: <robot type="…">, or, up to Aseba 1.5, an element that is named after the type."""

_SILENT = {"author", "thanks", "externalLink", "color", "area", "description", "world"}
_NOT_EXPRESSED = {
    "camera": "the view is chosen in the page",
    "feeder": "energy feeders are for e-pucks only",
    "process": "no other program is started with the simulation",
}


def convert(root: Element, name: str) -> Conversion:
    """Convert the playground below <aseba-playground>. Raises FieldError with the line of an error."""
    if root.tag != ROOT:
        raise FieldError(f"line {root.line}", f"<{root.tag}>", f"<{ROOT}>")
    return _Reader(root, name).read()


class _Reader:
    """Converts one playground."""

    def __init__(self, root: Element, name: str) -> None:
        self._root = root
        self._remarks: list[tuple[int, str]] = []
        descriptions = self._descriptions()
        english = descriptions.pop("en", next(iter(descriptions.values()), ""))
        self._out = Conversion(title=name, description=english)
        for language, text in descriptions.items():
            self._out.translations[language] = {"title": name, "description": text}
        self._names = Names()
        self._colors = {
            element.attributes.get("name", ""): _color(element) for element in root.children if element.tag == "color"
        }
        self._areas = {
            element.attributes.get("name", ""): [
                [_length(point, "x"), _length(point, "y")] for point in element.children if point.tag == "point"
            ]
            for element in root.children
            if element.tag == "area"
        }
        self._doors: dict[str, str] = {}

    def read(self) -> Conversion:
        self._world()
        readers: dict[str, Callable[[Element], None]] = {
            "wall": self._wall,
            "cylinder": self._cylinder,
            "door": self._door,
            "activation": self._activation,
            **dict.fromkeys(_ROBOTS, self._robot),
        }
        for reader in dict.fromkeys(readers.values()):
            for element in self._root.children:
                if readers.get(element.tag) == reader:
                    reader(element)
        for element in self._root.children:
            if element.tag not in readers and element.tag not in _SILENT:
                self._note(element, _NOT_EXPRESSED.get(element.tag, "unknown element"))
        self._out.notes = [text for _, text in sorted(self._remarks, key=lambda remark: remark[0])]
        return self._out

    def _descriptions(self) -> dict[str, str]:
        """Descriptions by language code, each in one line; the default is English, `de_CH` becomes `de-ch`."""
        found: dict[str, str] = {}
        for element in self._elements("description"):
            language = (element.attributes.get("lang", "").strip() or "en").lower().replace("_", "-")
            if not re.fullmatch(LANGUAGE, language):
                self._note(element, f"'{language}' is not a language code")
                continue
            text = "".join(part.text for part in element.walk())
            found.setdefault(language, " ".join(text.split())[:2000])
        return found

    def _elements(self, tag: str) -> Iterator[Element]:
        return (element for element in self._root.children if element.tag == tag)

    def _remark(self, element: Element, text: str) -> None:
        self._remarks.append((element.line, f"{_place(element)}{text}"))

    def _note(self, element: Element, why: str) -> None:
        self._remark(element, f" skipped: {why}")

    def _world(self) -> None:
        worlds = list(self._elements("world"))
        if len(worlds) != 1:
            raise FieldError(f"line {self._root.line}", f"{len(worlds)} <world> elements", "exactly one")
        (world,) = worlds
        width, height = _length(world, "w"), _length(world, "h")
        if min(width, height) <= 0.0:
            side = "w" if width <= 0.0 else "h"
            found = f"'{world.attributes.get(side, '')}'"
            raise FieldError(f"{_place(world)} {side}", found, "a number above 0")
        middle = {"x_m": rounded(width / 2), "y_m": rounded(height / 2)}
        self._out.add_shape(
            _place(world),
            {
                "kind": "rectangle",
                "name": self._names.take("ground", "ground"),
                **middle,
                "size_x_m": rounded(width + WALL_M),
                "size_y_m": rounded(height + WALL_M),
                "color": self._color_of(world),
                "walls": {"height_m": WALL_HEIGHT_M, "thickness_m": WALL_M},
            },
        )
        texture = world.attributes.get("groundTexture", "")
        if texture:
            self._out.add_shape(
                f"{_place(world)} groundTexture",
                {
                    "kind": "picture",
                    "name": self._names.take("ground_picture", "ground_picture"),
                    "image": texture,
                    **middle,
                    "size_x_m": width,
                    "size_y_m": height,
                },
            )
        if world.attributes.get("energyScoringSystemEnabled", "false").lower() in ("true", "1"):
            self._remark(world, ": energy score skipped, as it is for e-pucks only")

    def _wall(self, element: Element) -> None:
        self._out.add_shape(
            _place(element),
            {
                "kind": "box",
                "name": self._names.take(element.attributes.get("name", "wall"), "wall"),
                "x_m": _length(element, "x"),
                "y_m": _length(element, "y"),
                "size_x_m": _length(element, "l1"),
                "size_y_m": _length(element, "l2"),
                "height_m": _height(element),
                "yaw_rad": turned(_number(element, "angle")),
                "color": self._color_of(element),
                "mass_kg": _mass_kg(element),
            },
        )

    def _cylinder(self, element: Element) -> None:
        self._out.add_shape(
            _place(element),
            {
                "kind": "cylinder",
                "name": self._names.take(element.attributes.get("name", "cylinder"), "cylinder"),
                "x_m": _length(element, "x"),
                "y_m": _length(element, "y"),
                "radius_m": _length(element, "r"),
                "height_m": _height(element),
                "color": self._color_of(element),
                "mass_kg": _mass_kg(element),
            },
        )

    def _door(self, element: Element) -> None:
        wanted = element.attributes.get("name", "")
        name = self._doors[wanted] = self._names.take(wanted, "door")
        self._out.add_shape(
            _place(element),
            {
                "kind": "door",
                "name": name,
                "closed_x_m": _length(element, "closedX"),
                "closed_y_m": _length(element, "closedY"),
                "opened_x_m": _length(element, "openedX"),
                "opened_y_m": _length(element, "openedY"),
                "size_x_m": _length(element, "l1"),
                "size_y_m": _length(element, "l2"),
                "height_m": _height(element),
                "move_s": max(LEAST_MOVE_S, _number(element, "moveDuration")),
                "color": self._color_of(element),
            },
        )

    def _activation(self, element: Element) -> None:
        area, door = element.attributes.get("area", ""), element.attributes.get("door", "")
        if area not in self._areas:
            raise FieldError(
                _place(element), f"the area '{area}'", f"a declared area ({', '.join(self._areas) or 'there is none'})"
            )
        if door not in self._doors:
            raise FieldError(
                _place(element), f"the door '{door}'", f"a declared door ({', '.join(self._doors) or 'there is none'})"
            )
        self._out.add_shape(
            _place(element),
            {
                "kind": "activation",
                "name": self._names.take(element.attributes.get("name", ""), "activation"),
                "x_m": _length(element, "x"),
                "y_m": _length(element, "y"),
                "size_x_m": _length(element, "l1"),
                "size_y_m": _length(element, "l2"),
                "area_m": self._areas[area],
                "door": self._doors[door],
            },
        )

    def _robot(self, element: Element) -> None:
        kind = element.attributes.get("type", _THYMIO) if element.tag == _ROBOTS[0] else element.tag
        if kind != _THYMIO:
            self._note(element, f"robot type '{kind}', only the Thymio II is simulated")
            return
        index = len(self._out.robots)
        self._out.add_robot(
            _place(element),
            {
                "name": self._names.take(element.attributes.get("name") or f"thymio {index}", "thymio"),
                "x_m": _length(element, "x"),
                "y_m": _length(element, "y"),
                "yaw_rad": turned(_number(element, "angle")),
            },
        )
        for attribute in ("port", "nodeId"):
            if attribute in element.attributes:
                self._remark(element, f": {attribute} skipped, as robots are identified by name")

    def _color_of(self, element: Element) -> str:
        name = element.attributes.get("color", "")
        if name not in self._colors:
            self._remark(element, f": color '{name}' is not declared, gray is used")
        return self._colors.get(name, DEFAULT_COLOR)


def _place(element: Element) -> str:
    return f"line {element.line}: <{element.tag}>"


def _color(element: Element) -> str:
    parts = [min(1.0, max(0.0, _number(element, part))) for part in ("r", "g", "b")]
    return "#" + "".join(f"{round(part * 255):02x}" for part in parts)


def _mass_kg(element: Element) -> float | None:
    """The mass of a movable object; None for a fixed one."""
    mass = _number(element, "mass", default=-1.0)
    return None if mass < 0 else max(LEAST_MASS_KG, min(MOST_MASS_KG, rounded(mass * KG_PER_MASS)))


def _height(element: Element) -> float:
    height_m = _length(element, "h")
    return LEAST_HEIGHT_M if 0.0 <= height_m < LEAST_HEIGHT_M else height_m


def _length(element: Element, attribute: str) -> float:
    """An attribute in centimeters as meters."""
    return rounded(_number(element, attribute) / 100)


def _number(element: Element, attribute: str, default: float = 0.0) -> float:
    text = element.attributes.get(attribute, "").strip()
    if not text:
        return default
    try:
        value = float(text.replace("_", "?"))  # Python alone takes 1_000 for a number
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise FieldError(f"{_place(element)} {attribute}", f"'{text[:40]}'", "a number")
    return value
