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


def test_on_a_large_cluster_groups_take_longer() -> None:
    assert sizes_after((100, 50.0)).next(100_000, 800) == 16  # 8 s


def test_groups_of_no_duration_have_one_task() -> None:
    sizes = GroupSize(0.0)
    sizes.add(1, 0.001)
    assert sizes.next(1000, 2) == 1


@pytest.mark.parametrize(("waiting", "size"), [(1000, 250), (400, 100), (300, 75), (200, 62), (3, 3)])
def test_the_last_tasks_are_shared_but_not_one_by_one(waiting: int, size: int) -> None:
    assert sizes_after((50, 0.1)).next(waiting, 2) == size
