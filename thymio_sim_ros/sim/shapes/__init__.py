"""Kinds of shapes, one file each: fields with their units, and the primitives that they become.

A module exports SHAPE, a `ShapeKind` whose `form` is a frozen dataclass with rules from `sim/model/fields.py`.
`declaration` is what the page's creator needs to offer, edit and check a kind.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from thymio_sim_ros.files import registry
from thymio_sim_ros.sim.model.field_declarations import field_declarations, sample_values
from thymio_sim_ros.sim.model.fields import image_keys, json_schema, read
from thymio_sim_ros.sim.model.primitive_declarations import primitive_declarations
from thymio_sim_ros.sim.model.primitives import Floor, Paint, Primitive, Print

__all__ = ["Shape", "ShapeKind", "all_shapes", "declaration", "own_shapes"]

_PIXEL = (
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
)
"""Stands for an image where a sample needs one."""


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
    primitives = _primitives(kind, sample)
    return {
        "group": _group(primitives),
        "fields": field_declarations(kind.form),
        "sample": sample,
        "primitives": primitive_declarations(primitives),
        "labels": dict(kind.labels),
        "field_labels": {name: dict(labels) for name, labels in kind.field_labels.items()},
    }


def _primitives(kind: ShapeKind, sample: Mapping[str, Any]) -> tuple[Primitive, ...]:
    """The primitives of a sample whose pose is the origin; none if they cannot be built."""
    fields = field_declarations(kind.form)
    values = dict(sample)
    values |= dict.fromkeys(image_keys(kind.form), _PIXEL)
    values |= {key: 0.0 for key in ("x_m", "y_m", "yaw_rad") if key in fields}
    try:
        return read(kind.form, values, "sample").primitives(kind.name)
    except Exception:  # of a shape of another package; a playground with it is refused with the error
        return ()


def _group(primitives: Sequence[Primitive]) -> str:
    if any(isinstance(primitive, Floor) for primitive in primitives):
        return "ground"
    is_paint = bool(primitives) and all(isinstance(primitive, Paint | Print) for primitive in primitives)
    return "paint" if is_paint else "object"


def _check(kind: ShapeKind) -> None:
    """Raise TypeError or ValueError for a kind that no file can be read into or that cannot be declared to the page."""
    json_schema(kind.form)
    json.dumps(declaration(kind), allow_nan=False)
