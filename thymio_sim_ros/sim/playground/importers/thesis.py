"""Converter of JSON playgrounds of the web simulation of the bachelor thesis.

Source: docs/spec/playground-formats.md section 2.

Its scene has X to the right, Z towards the viewer, Y up, and units of 20 mm: x = X, y = -Z, z = Y, each times 0.02;
a turn about Y keeps its sign. Read as the recommendations say: unknown keys are passed over with a note.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from thymio_sim_ros.sim.formats import image_io
from thymio_sim_ros.sim.model.fields import FieldError, describe, join
from thymio_sim_ros.sim.playground.importers import Conversion
from thymio_sim_ros.sim.playground.importers.names import Names, rounded, turned

__all__ = ["KEYS", "convert"]

UNIT_M = 0.02
WALLS = {"height_m": 6 * UNIT_M, "thickness_m": UNIT_M}
TRACK_WIDTH_M = UNIT_M

KEYS = ("planes", "octagons", "boxes", "cylinders", "uShapes", "tracks", "thymios")
"""Keys that only such files have, besides "playground", the title."""


def convert(data: Mapping[str, object], name: str) -> Conversion:
    """Convert the playground. Raises FieldError with the key of an error."""
    title = data.get("playground", name)
    if not isinstance(title, str):
        raise FieldError("playground", describe(title), "a title")
    return _Reader(data, title).read()


class _Item:
    """One object of the file; its members may stand in it or in its `props`."""

    def __init__(self, value: object, key: str) -> None:
        if not isinstance(value, Mapping):
            raise FieldError(key, describe(value), "an object")
        props = value.get("props", {})
        if not isinstance(props, Mapping):
            raise FieldError(join(key, "props"), describe(props), "an object")
        self.key = key
        self._members = {**value, **props}
        self._known = {"props", "name"}

    def number(self, name: str, default: float | None = None) -> float:
        """A member that is a finite number; it may be missing if there is a default. Raises FieldError."""
        self._known.add(name)
        value = self._members.get(name, default)
        if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < 1e9:
            raise FieldError(join(self.key, name), "nothing" if value is None else describe(value), "a number")
        return float(value)

    def length(self, name: str, default: float | None = None) -> float:
        """A member in units as meters. Raises FieldError."""
        return rounded(self.number(name, default) * UNIT_M)

    def place(self, *, otherwise: float | None = None) -> dict[str, float]:
        """Its position in the world's frame in m. Raises FieldError."""
        x, z = self.number("positionX", otherwise), self.number("positionZ", otherwise)
        return {"x_m": rounded(x * UNIT_M), "y_m": rounded(-z * UNIT_M)}

    def get(self, name: str) -> object:
        """Any member, or None."""
        self._known.add(name)
        return self._members.get(name)

    def unknown(self) -> list[str]:
        """The keys that were not read."""
        return [str(name) for name in self._members if name not in self._known]


class _Reader:
    """Converts one playground."""

    def __init__(self, data: Mapping[str, object], title: str) -> None:
        self._data = data
        self._out = Conversion(title=" ".join(title.split()) or "Playground")
        self._names = Names()

    def read(self) -> Conversion:
        readers: dict[str, Callable[[_Item], dict[str, Any]]] = {
            "planes": self._plane,
            "octagons": self._octagon,
            "tracks": self._track,
            "boxes": self._box,
            "cylinders": self._cylinder,
            "uShapes": self._u_shape,
        }
        for key, reader in readers.items():
            kind = key.removesuffix("es") if key == "boxes" else key.removesuffix("s")
            for item in self._items(key):
                name = self._names.take(str(item.get("name") or ""), kind.lower())
                members = reader(item)
                self._out.add_shape(item.key, {"kind": members.pop("kind"), "name": name, **members})
                self._note_unknown(item)
        self._robots()
        for key in self._data:
            if key not in (*KEYS, "playground"):
                self._out.notes.append(f"{key} skipped: unknown key")
        return self._out

    def _items(self, key: str) -> list[_Item]:
        value = self._data.get(key, [])
        if key == "thymios" and isinstance(value, Mapping):
            return [_Item(value, key)]
        if not isinstance(value, list):
            raise FieldError(key, describe(value), "a list")
        return [_Item(item, f"{key}[{index}]") for index, item in enumerate(value)]

    def _note_unknown(self, item: _Item) -> None:
        self._out.notes.extend(f"{item.key}.{name} skipped: unknown key" for name in item.unknown())

    def _plane(self, item: _Item) -> dict[str, Any]:
        size = {"size_x_m": item.length("width"), "size_y_m": item.length("height")}
        return {"kind": "rectangle", **size, "color": _color(item), "walls": _walls(item)}

    def _octagon(self, item: _Item) -> dict[str, Any]:
        side = item.length("segmentLength")
        return {"kind": "octagon", "side_m": side, "color": _color(item), "walls": _walls(item)}

    def _track(self, item: _Item) -> dict[str, Any]:
        points = item.get("points")
        if not isinstance(points, list):
            raise FieldError(f"{item.key}.points", describe(points), "a list")
        places = [_Item(point, f"{item.key}.points[{index}]").place() for index, point in enumerate(points)]
        points_m = [[place["x_m"], place["y_m"]] for place in places]
        return {"kind": "track", "points_m": points_m, "width_m": TRACK_WIDTH_M, "color": _color(item)}

    def _box(self, item: _Item) -> dict[str, Any]:
        size = {"size_x_m": item.length("width"), "size_y_m": item.length("depth"), "height_m": item.length("height")}
        yaw_rad = turned(item.number("rotateY", 0.0))
        return {"kind": "box", **item.place(), **size, "yaw_rad": yaw_rad, "color": _color(item)}

    def _cylinder(self, item: _Item) -> dict[str, Any]:
        top, bottom = item.length("topRadius"), item.length("botRadius")
        if top != bottom:
            self._out.notes.append(f"{item.key}: cone replaced by a cylinder of its larger radius")
        size = {"radius_m": max(top, bottom), "height_m": item.length("height")}
        return {"kind": "cylinder", **item.place(), **size, "color": _color(item)}

    def _u_shape(self, item: _Item) -> dict[str, Any]:
        size = {"unit_m": item.length("size"), "height_m": item.length("height")}
        return {"kind": "u_figure", **item.place(otherwise=0.0), **size, "color": _color(item)}

    def _robots(self) -> None:
        items = self._items("thymios")
        for item in items:
            name = self._names.take(str(item.get("name") or ""), "thymio")
            # The model looks along +Z and is turned a quarter to look along +X.
            yaw_rad = turned(item.number("rotateY", math.pi / 2) - math.pi / 2)
            self._out.add_robot(item.key, {"name": name, **item.place(otherwise=0.0), "yaw_rad": yaw_rad})
            self._note_unknown(item)
        if not items:
            self._out.notes.append("thymios: none found, one robot starts at the origin")
            name = self._names.take("thymio", "thymio")
            self._out.add_robot("thymios", {"name": name, "x_m": 0.0, "y_m": 0.0, "yaw_rad": 0.0})


def _walls(item: _Item) -> dict[str, float] | None:
    walls = item.get("hasWalls")
    if not isinstance(walls, bool | None):
        raise FieldError(f"{item.key}.hasWalls", describe(walls), "true or false")
    return dict(WALLS) if walls else None


def _color(item: _Item) -> str:
    return image_io.css_color(item.get("color"), key=f"{item.key}.color")
