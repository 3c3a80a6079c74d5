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

__all__ = ["set_by_properties", "set_one_by_one"]

Values = npt.NDArray[np.float64]


def set_by_properties(bodies: Sequence[pymunk.Body], motion: Values) -> None:
    """Velocity, rate of turn and, if there are more columns, force and torque: a row for each body."""
    for body, row in zip(bodies, motion.tolist(), strict=True):
        body.velocity, body.angular_velocity = (row[0], row[1]), row[2]
        if len(row) > 3:
            body.force, body.torque = (row[3], row[4]), row[5]


def _set_by_function(bodies: Sequence[pymunk.Body], fields: batch.BodyFields, motion: Values) -> None:
    buffer = batch.Buffer()
    buffer.set_float_buf(motion)
    data = _chipmunk_cffi.ffi.new("pmBatchedData *")
    data.fields, data.floatArray, data.intArray = fields.value, buffer._float_arr, buffer._int_arr
    buffer._float_arr.num = 0  # it is read from its beginning
    setter = _chipmunk_cffi.lib.pmSpaceBodySetIteratorFuncBatched
    deque(map(setter, [body._body for body in bodies], repeat(data)), maxlen=0)


def set_one_by_one(bodies: Sequence[pymunk.Body], fields: batch.BodyFields, motion: Values) -> None:
    """As `set_by_properties`; `fields` are those of the columns. Bodies that are not named sleep on."""
    try:
        _set_by_function(bodies, fields, np.ascontiguousarray(motion))
    except AttributeError:
        set_by_properties(bodies, motion)
