"""Groups: small at first and at the end, otherwise as large as their duration allows."""

from __future__ import annotations

import pytest

from thymio_sim_ros.batch_runs.group_size import GROUP_S, GROWTH, GroupSize


def sizes_after(*groups: tuple[int, float]) -> GroupSize:
    sizes = GroupSize()
    for tasks, seconds in groups:
        sizes.add(tasks, seconds)
    return sizes


def test_a_first_group_has_one_task() -> None:
    assert GroupSize().next(1000, 2) == 1


def test_short_tasks_make_groups_that_take_a_while() -> None:
    sizes = sizes_after((20, 0.2), (20, 0.2))
    assert sizes.next(100_000, 2) == GROUP_S / 0.01


def test_long_tasks_are_alone() -> None:
    assert sizes_after((1, 30.0)).next(1000, 2) == 1


def test_groups_grow_step_by_step() -> None:
    assert sizes_after((1, 0.0)).next(100_000, 2) == GROWTH


@pytest.mark.parametrize(("waiting", "size"), [(400, 100), (41, 10), (3, 1)])
def test_the_last_tasks_are_shared_by_all_threads(waiting: int, size: int) -> None:
    assert sizes_after((50, 0.1)).next(waiting, 2) == size
