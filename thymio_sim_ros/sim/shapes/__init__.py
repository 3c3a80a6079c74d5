"""Kinds of shapes, one file each: fields with their units, and the primitives that they become.

A module exports SHAPE, a `ShapeKind` whose `form` is a frozen dataclass with rules from `sim/model/fields.py`.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from typing import Protocol

from thymio_sim_ros import registry
from thymio_sim_ros.sim.model.fields import json_schema
from thymio_sim_ros.sim.model.primitives import Primitive

__all__ = ["Shape", "ShapeKind", "all_shapes"]


class Shape(Protocol):
    """A shape of a playground file, checked and complete."""

    def primitives(self, name: str) -> tuple[Primitive, ...]:
        """What it is made of, in the world's frame; later paint covers earlier paint."""
        ...


@dataclass(frozen=True, slots=True)
class ShapeKind:
    """One kind of shape: its name in files, and the dataclass that holds its fields."""

    name: str
    form: type[Shape]


def all_shapes() -> tuple[ShapeKind, ...]:
    """Every kind of this folder and of other packages, in name order."""
    return registry.collect(sys.modules[__name__], "SHAPE", ShapeKind, check=_check)


def _check(kind: ShapeKind) -> None:
    """Raise TypeError for a class that no file can be read into."""
    json_schema(kind.form)
