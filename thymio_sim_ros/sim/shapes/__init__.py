"""Kinds of shapes, one file each: fields with their units, and the primitives that they become.

A module exports SHAPE, a `ShapeKind` whose `form` is a frozen dataclass with rules from `sim/model/fields.py`.
`declaration` is what the page's creator needs to offer, edit and check a kind, `drawing` what it draws of a shape.
"""

from __future__ import annotations

import itertools
import json
import sys
from collections.abc import Mapping, Set
from dataclasses import dataclass, field
from typing import Any, Protocol

from thymio_sim_ros.files import registry
from thymio_sim_ros.sim.model.field_declarations import field_declarations, sample_values
from thymio_sim_ros.sim.model.fields import FieldError, image_keys, json_schema, read
from thymio_sim_ros.sim.model.primitive_declarations import primitive_declarations
from thymio_sim_ros.sim.model.primitives import Primitive

__all__ = ["Shape", "ShapeKind", "all_shapes", "declaration", "drawing", "own_shapes", "primitives_of"]

_PNG = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAA"
_STAND_INS = (
    f"{_PNG}BCAAAAAA6fptVAAAACklEQVR42mNgAAAAAgAB5Sfe/AAAAABJRU5ErkJggg==",
    f"{_PNG}CCAAAAAC86un7AAAADElEQVR42mNgYGAAAAAEAAHI6uv5AAAAAElFTkSuQmCC",
)
"""Images of one and of two rows; a drawing has one of them for each image of the shape."""


class Shape(Protocol):
    """A shape of a playground file, checked and complete."""

    def primitives(self, name: str) -> tuple[Primitive, ...]:
        """The primitives of the shape, in the world's frame; later paint covers earlier paint."""
        ...


@dataclass(frozen=True, slots=True)
class ShapeKind:
    """One kind of shape: its name in files, the dataclass that holds its fields, and what the page's creator shows.

    `sample` holds values of a new item in the creator; a required field without one starts with a value within its
    limits. `labels` is the name that people read, by language code; `field_labels` the same for each field. The page
    has names for the fields of this package's shapes (`size_x_m`, `color`, ...), and makes one from the key otherwise.
    """

    name: str
    form: type[Shape]
    sample: Mapping[str, Any] = field(default_factory=dict)
    labels: Mapping[str, str] = field(default_factory=dict)
    field_labels: Mapping[str, Mapping[str, str]] = field(default_factory=dict)


def all_shapes() -> tuple[ShapeKind, ...]:
    """Every kind of this folder and of other packages, in name order."""
    return registry.collect(sys.modules[__name__], "SHAPE", ShapeKind, check=_check)


def own_shapes() -> tuple[ShapeKind, ...]:
    """The kinds of this folder, in name order."""
    own = registry.own_names(sys.modules[__name__])
    return tuple(kind for kind in all_shapes() if kind.name in own)


def declaration(kind: ShapeKind) -> dict[str, Any]:
    """A kind as JSON: `group`, `fields`, `sample`, `primitives` of the sample, `labels` and `field_labels`.

    The group is `ground` if the sample has a floor, `paint` if it has nothing but paint, else `object`. Raises
    TypeError if a field has no rule or the sample has a value for an unknown field.
    """
    sample = sample_values(kind.form, kind.sample)
    fields = field_declarations(kind.form)
    at_origin: dict[str, Any] = {key: 0.0 for key in ("x_m", "y_m", "yaw_rad") if key in fields}
    try:
        drawn = drawing(kind, {**sample, **dict.fromkeys(image_keys(kind.form), ""), **at_origin})
    except FieldError:  # of a shape of another package; a playground with it is refused with the error
        drawn = []
    return {
        "group": _group({part["type"] for part in drawn}),
        "fields": fields,
        "sample": sample,
        "primitives": drawn,
        "labels": dict(kind.labels),
        "field_labels": {name: dict(labels) for name, labels in kind.field_labels.items()},
    }


def drawing(kind: ShapeKind, values: Mapping[str, Any]) -> list[dict[str, Any]]:
    """What the page draws of a shape with these values, as `primitive_declarations`, without reading its images.

    An image is any value but None. `image` of a print is the first field with one, and `sizeY` is None if it follows
    from the proportions of the image. Raises FieldError for values that `read` or the shape refuses.
    """
    images = [key for key in image_keys(kind.form) if values.get(key) is not None]
    forms = [read(kind.form, {**values, **dict.fromkeys(images, one)}, "") for one in _STAND_INS[: 1 + bool(images)]]
    drawn, *taller = [primitive_declarations(primitives_of(kind.name, form, kind.name)) for form in forms]
    for part, other in itertools.chain.from_iterable(zip(drawn, one, strict=False) for one in taller):
        if part["type"] == "print":
            part["image"] = images[0]
            part["sizeY"] = part["sizeY"] if part["sizeY"] == other.get("sizeY") else None
    return drawn


def primitives_of(kind: str, shape: Shape, name: str) -> tuple[Primitive, ...]:
    """The primitives of a shape of this kind and name. Raises FieldError for any exception of it."""
    try:
        return tuple(shape.primitives(name))
    except FieldError:
        raise
    except ValueError as error:
        raise FieldError("", str(error), f"a valid {kind}") from error
    except Exception as error:  # of a shape that another package added
        raise FieldError("", f"{type(error).__name__}: {error}", f"a valid {kind}") from error


def _group(types: Set[str]) -> str:
    if "floor" in types:
        return "ground"
    return "paint" if types and types <= {"paint", "print"} else "object"


def _check(kind: ShapeKind) -> None:
    """Raise TypeError or ValueError for a kind that no file can be read into or that cannot be declared to the page."""
    json_schema(kind.form)
    json.dumps(declaration(kind), allow_nan=False)
