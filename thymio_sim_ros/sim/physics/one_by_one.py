"""Speeds and forces of single bodies, set by the function with which pymunk sets those of all (`pymunk.batch`).

That function is not public; where a pymunk has none, the public properties do the same, ten times slower.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from itertools import repeat

import numpy as np
import numpy.typing as npt
import pymunk
from pymunk import _chipmunk_cffi, batch

__all__ = ["Setter", "set_by_properties"]

Values = npt.NDArray[np.float64]


class Setter:
    """Sets some bodies of a space; those that are not named sleep on."""

    def __init__(self, bodies: Sequence[pymunk.Body]) -> None:
        self._bodies = bodies
        self._buffer = batch.Buffer()
        self._function = getattr(_chipmunk_cffi.lib, "pmSpaceBodySetIteratorFuncBatched", None)
        if self._function is not None:
            self._handles = [body._body for body in bodies]
            self._data = _chipmunk_cffi.ffi.new("pmBatchedData *")
            self._data.floatArray, self._data.intArray = self._buffer._float_arr, self._buffer._int_arr

    def set(self, fields: batch.BodyFields, motion: Values) -> None:
        """As `set_by_properties`; `fields` are those of the columns."""
        if self._function is None:
            set_by_properties(self._bodies, motion)
            return
        self._buffer.set_float_buf(np.ascontiguousarray(motion))
        self._buffer._float_arr.num = 0  # it is read from its beginning
        self._data.fields = fields.value
        deque(map(self._function, self._handles, repeat(self._data)), maxlen=0)


def set_by_properties(bodies: Sequence[pymunk.Body], motion: Values) -> None:
    """Velocity, rate of turn and, if there are more columns, force and torque: a row for each body."""
    for body, row in zip(bodies, motion.tolist(), strict=True):
        body.velocity, body.angular_velocity = (row[0], row[1]), row[2]
        if len(row) > 3:
            body.force, body.torque = (row[3], row[4]), row[5]
