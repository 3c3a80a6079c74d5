"""Single bodies of a space, set all at once; pymunk's properties are the oracle."""

from __future__ import annotations

import gc
import weakref

import numpy as np
import numpy.typing as npt
import pymunk
import pytest

from thymio_sim_ros.sim.physics import pymunk_batch_io
from thymio_sim_ros.sim.physics.pymunk_batch_io import BodyReader, BodyWriter, set_by_properties


def space(count: int) -> tuple[pymunk.Space, list[pymunk.Body]]:
    """Bodies far from each other."""
    found = pymunk.Space()
    bodies = []
    for index in range(count):
        body = pymunk.Body(1.0, 1.0)
        body.position = (10.0 * index, 0.0)
        found.add(body, pymunk.Circle(body, 1.0))
        bodies.append(body)
    return found, bodies


def motions(bodies: list[pymunk.Body]) -> list[tuple[float, ...]]:
    return [(*body.velocity, body.angular_velocity, *body.force, body.torque) for body in bodies]


def writer(bodies: list[pymunk.Body], rows: npt.NDArray[np.float64]) -> BodyWriter:
    found = BodyWriter(rows)
    found.choose(bodies)
    return found


def test_every_body_gets_its_row() -> None:
    one, other = space(5)[1], space(5)[1]
    motion = np.arange(30.0).reshape(5, 6)
    writer(one, motion).write()
    set_by_properties(other, motion)
    assert motions(one) == motions(other)
    assert one[3].velocity == (18.0, 19.0)


def test_a_writer_writes_what_its_rows_have_now() -> None:
    bodies, rows = space(3)[1], np.ones((3, 6))
    writing = writer(bodies, rows)
    writing.write()
    rows[:] = 7.0
    writing.write()
    assert motions(bodies) == [(7.0,) * 6] * 3


def test_without_pymunks_function_the_properties_do_it(monkeypatch: pytest.MonkeyPatch) -> None:
    class Nothing:
        lib = None

    monkeypatch.setattr(pymunk_batch_io, "_chipmunk_cffi", Nothing)
    bodies = space(2)[1]
    writer(bodies, np.arange(12.0).reshape(2, 6)).write()
    assert [body.angular_velocity for body in bodies] == [2.0, 8.0]


def test_a_writer_may_choose_other_bodies_and_more_of_them() -> None:
    bodies, rows = space(9)[1], np.ones((9, 6))
    writing = writer(bodies[:1], rows)
    writing.write()
    writing.choose(bodies[1:])
    rows[:] = np.arange(54.0).reshape(9, 6)
    writing.write()
    assert [body.angular_velocity for body in bodies] == [1.0, *(6.0 * index + 2 for index in range(8))]


def test_bodies_that_are_not_chosen_sleep_on() -> None:
    found, bodies = space(2)
    found.sleep_time_threshold = 0.1
    writing = writer(bodies[:1], np.array([[0.1, 0.0, 0.0, 0.0, 0.0, 0.0]]))
    for _ in range(30):
        writing.write()
        found.step(0.01)
    assert [body.is_sleeping for body in bodies] == [False, True]


def test_a_sleeping_body_that_is_written_moves() -> None:
    found, bodies = space(1)
    found.sleep_time_threshold = 0.1
    for _ in range(30):
        found.step(0.01)
    assert bodies[0].is_sleeping
    writing = writer(bodies, np.array([[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]]))
    for _ in range(10):
        writing.write()
        found.step(0.01)
    assert bodies[0].position.x == pytest.approx(0.1)


@pytest.mark.parametrize("is_prepared", [True, False])
def test_a_reader_finds_bodies_in_whatever_order_the_space_has_them(
    is_prepared: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Nothing:
        lib = None

    if not is_prepared:
        monkeypatch.setattr(pymunk_batch_io, "_chipmunk_cffi", Nothing)
    found, bodies = space(4)
    set_by_properties(bodies, np.arange(12.0).reshape(4, 3))
    reader = BodyReader(found)
    reader.read()
    expected = [(10.0 * index, 0.0, 0.0, 3.0 * index, 3.0 * index + 1, 3.0 * index + 2) for index in range(4)]
    assert reader.state[reader.rows(bodies)].tolist() == [list(row) for row in expected]
    order = reader.order
    reader.read()
    assert reader.order == order
    found.remove(bodies[0], *bodies[0].shapes)
    reader.read()
    assert reader.order != order
    assert reader.state[reader.rows(bodies[1:])].tolist() == [list(row) for row in expected[1:]]


def test_a_reader_keeps_no_body_that_was_removed() -> None:
    found, bodies = space(2)
    reader = BodyReader(found)
    reader.read()
    reader.rows(bodies)
    gone = bodies.pop()
    found.remove(gone, *gone.shapes)
    reader.read()
    reader.rows(bodies)
    reference = weakref.ref(gone)
    del gone
    gc.collect()
    assert reference() is None
