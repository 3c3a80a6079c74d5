"""What the page's creator draws of the shapes of a playground that is being edited."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from thymio_sim_ros.sim.model.fields import FieldError, describe, nearest
from thymio_sim_ros.sim.playground import format_detection
from thymio_sim_ros.sim.playground.reader import MAX_PRIMITIVES, MAX_SHAPES
from thymio_sim_ros.sim.shapes import ShapeKind, all_shapes, drawing

__all__ = ["drawings"]

_FAULT = ("key", "found", "expected", "word")


def drawings(text: str) -> str:
    """The drawings of shapes, both as JSON lists; shapes are those of a playground file, without names.

    A drawing is `{"primitives": [...]}` as from `sim/shapes.drawing`, or `{"fault": {"key", "found", "expected",
    "word"}}`: the key in the shape, what was found and expected in English, and the rule's name in the texts of the
    page, empty if it has none. Raises FieldError for anything but a list of at most `MAX_SHAPES`.
    """
    data = text.encode("utf-8", "replace")
    shapes = format_detection.read_source(data, "", format_detection.nothing_beside).data
    if not isinstance(shapes, list) or len(shapes) > MAX_SHAPES:
        raise FieldError("shapes", describe(shapes), f"a list of at most {MAX_SHAPES}")
    kinds = {kind.name: kind for kind in all_shapes()}
    found = []
    left = MAX_PRIMITIVES
    for shape in shapes:
        try:
            drawn = _drawing(shape, kinds) if left >= 0 else []
            left -= len(drawn)
            if left < 0:
                raise FieldError("", f"more than {MAX_PRIMITIVES} parts", "a simpler playground", "tooMuch")
            found.append(json.dumps({"primitives": drawn}, allow_nan=False))
        except Exception as error:  # a shape of another package may raise anything, also by values that are not numbers
            other = FieldError("", f"{type(error).__name__}: {error}", "primitives")
            fault = error if isinstance(error, FieldError) else other
            found.append(json.dumps({"fault": {key: getattr(fault, key) for key in _FAULT}}))
    return f"[{', '.join(found)}]"


def _drawing(shape: object, kinds: Mapping[str, ShapeKind]) -> list[dict[str, Any]]:
    if not isinstance(shape, Mapping):
        raise FieldError("", describe(shape), "an object")
    kind, values = shape.get("kind"), {key: shape[key] for key in shape if key != "kind"}
    if not isinstance(kind, str) or kind not in kinds:
        raise FieldError("kind", describe(kind), nearest(str(kind), tuple(kinds)), "kind")
    return drawing(kinds[kind], values)
