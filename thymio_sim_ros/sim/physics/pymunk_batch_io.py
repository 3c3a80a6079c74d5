"""Write single bodies of a pymunk space and read all of them, by the C functions behind `pymunk.batch`.

Two of these are not public: the function that writes a single body, and a prepared call of the function that reads all.
If a version of pymunk lacks them, the public API does the same, more slowly.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from functools import partial
from itertools import repeat
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
import numpy.typing as npt
import pymunk
from pymunk import _chipmunk_cffi, batch

__all__ = ["BodyReader", "BodyWriter", "set_by_properties"]

Values = npt.NDArray[np.float64]
Indices = npt.NDArray[np.intp]

_Fields = batch.BodyFields
_SPEEDS = _Fields.VELOCITY | _Fields.ANGULAR_VELOCITY
_FORCES = _SPEEDS | _Fields.FORCE | _Fields.TORQUE
_STATE = _Fields.BODY_ID | _Fields.POSITION | _Fields.ANGLE | _SPEEDS


class BodyWriter:
    """Writes velocities and forces to chosen bodies of a space; the others stay asleep.

    The public `batch.set_space_bodies` writes to all bodies of a space, and writing wakes a sleeping body. The C
    function behind it writes to one body and advances in the buffer; it is called here for each chosen body.
    """

    def __init__(self, rows: Values) -> None:
        """A row of `rows` for each body: velocity x, y, rate of turn, force x, y, torque."""
        self._rows, self._buffer = rows, batch.Buffer()
        self._buffer.set_float_buf(rows)
        self._function = getattr(_chipmunk_cffi.lib, "pmSpaceBodySetIteratorFuncBatched", None)
        self._data = None if self._function is None else _data(_FORCES, self._buffer)
        self.choose(())

    def choose(self, bodies: Sequence[pymunk.Body]) -> None:
        """Write the first rows to these bodies from now on."""
        self._bodies = bodies
        self._handles = [] if self._function is None else [body._body for body in bodies]

    def write(self) -> None:
        """Write the rows."""
        if self._function is None:
            set_by_properties(self._bodies, self._rows)
            return
        self._buffer._float_arr.num = 0  # rewinds the buffer: pymunk reads from the beginning
        deque(map(self._function, self._handles, repeat(self._data)), maxlen=0)


class BodyReader:
    """Reads all bodies of a space."""

    def __init__(self, space: pymunk.Space) -> None:
        self._buffer = batch.Buffer()
        self._each = _prepared_reader(space, self._buffer)
        self._ids = b""
        self._id_view: Any = b""
        self._room = (-1, 0, 0)
        """Values in the buffer, and the sizes of its arrays, when `state` and `_id_view` were made."""
        self._id_of: WeakKeyDictionary[pymunk.Body, int] = WeakKeyDictionary()
        self.order = 0
        """Increases whenever the order of the rows changes; rows found by `rows` are then no longer valid."""
        self.state = np.zeros((0, 6))
        """State of all bodies, shape (bodies, 6): x, y, angle, vx, vy, rate of turn. A view of pymunk's buffer, which
        the next `read` overwrites."""

    def read(self) -> None:
        """Update `state`, and `order` if bodies were added or removed or come in another order."""
        # `clear` sets the lengths to 0 and keeps the arrays, so views of them stay valid until an array is reallocated.
        buffer = self._buffer
        buffer.clear()
        self._each()
        floats = buffer._float_arr
        room = (floats.num, floats.max, buffer._int_arr.max)
        if room != self._room:  # pymunk moves an array only when it grows
            self._room = room
            self.state = np.frombuffer(buffer.float_buf()).reshape(-1, 6)
            self._id_view = buffer.int_buf()
        ids = self._id_view[:]
        if ids != self._ids:
            self._ids = ids
            self.order += 1

    def rows(self, bodies: Sequence[pymunk.Body]) -> Indices:
        """The rows of bodies in `state`, shape (bodies,). Raises KeyError for a body outside the space."""
        rows = {number: row for row, number in enumerate(np.frombuffer(self._ids, dtype=np.uintp).tolist())}
        known = self._id_of
        for body in bodies:
            if body not in known:
                known[body] = body.id
        return np.array([rows[known[body]] for body in bodies], dtype=np.intp)


def _prepared_reader(space: pymunk.Space, buffer: batch.Buffer) -> Callable[[], object]:
    """A function that reads all bodies of a space into a buffer.

    `batch.get_space_bodies` makes the same call but builds its arguments anew each time; here they are built once. The
    pointers are valid as long as space and buffer live, which the returned function keeps alive.
    """
    each = getattr(_chipmunk_cffi.lib, "cpSpaceEachBody", None)
    if each is None or not hasattr(_chipmunk_cffi.lib, "pmSpaceBodyGetIteratorFuncBatched"):
        return partial(batch.get_space_bodies, space, _STATE, buffer)
    function = _chipmunk_cffi.ffi.addressof(_chipmunk_cffi.lib, "pmSpaceBodyGetIteratorFuncBatched")
    return partial(each, space._space, function, _data(_STATE, buffer))


def _data(fields: batch.BodyFields, buffer: batch.Buffer) -> Any:
    """The C struct by which pymunk reads from a buffer or writes to it; it does not keep the buffer alive."""
    data = _chipmunk_cffi.ffi.new("pmBatchedData *")
    data.floatArray, data.intArray, data.fields = buffer._float_arr, buffer._int_arr, fields.value
    return data


def set_by_properties(bodies: Sequence[pymunk.Body], motion: Values) -> None:
    """Velocity, rate of turn and, if there are more columns, force and torque: a row for each body."""
    for body, row in zip(bodies, motion.tolist(), strict=False):
        body.velocity, body.angular_velocity = (row[0], row[1]), row[2]
        if len(row) > 3:
            body.force, body.torque = (row[3], row[4]), row[5]
