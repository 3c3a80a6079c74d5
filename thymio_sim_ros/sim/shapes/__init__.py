"""Kinds of shapes, one file each: fields with their units, and the primitives that they become.

A module exports SHAPE, a `ShapeKind` whose `form` is a frozen dataclass with rules from `sim/model/fields.py`.
`declaration` is what the page's creator needs to offer, edit and check a kind.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

from thymio_sim_ros import registry
from thymio_sim_ros.sim.model.field_declarations import field_declarations, sample_values
from thymio_sim_ros.sim.model.fields import image_keys, json_schema, read
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
    """A kind as JSON: `group` (`ground`, `paint` or `object`), `fields`, `sample`, `labels` and `field_labels`.

    The group is that of the primitives of the sample. Raises TypeError if a field has no rule; any exception if the
    kind has a sample that cannot be built.
    """
    sample = sample_values(kind.form, kind.sample)
    return {
        "group": _group(kind, sample),
        "fields": field_declarations(kind.form),
        "sample": sample,
        "labels": dict(kind.labels),
        "field_labels": {name: dict(labels) for name, labels in kind.field_labels.items()},
    }


def _group(kind: ShapeKind, sample: Mapping[str, Any]) -> str:
    images = dict.fromkeys(image_keys(kind.form), _PIXEL)
    try:
        primitives = read(kind.form, {**images, **sample}, "sample").primitives(kind.name)
    except Exception:  # of a shape of another package, which may have rules between fields
        if kind.sample:
            raise
        return "object"
    if any(isinstance(primitive, Floor) for primitive in primitives):
        return "ground"
    return "paint" if all(isinstance(primitive, Paint | Print) for primitive in primitives) else "object"


def _check(kind: ShapeKind) -> None:
    """Raise TypeError for a class that no file can be read into, and whatever `declaration` raises."""
    json_schema(kind.form)
    declaration(kind)
