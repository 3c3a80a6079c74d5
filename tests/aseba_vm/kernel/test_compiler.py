"""Kernels compiled give the bits that Python gives."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from aseba_vm.kernel.compiler import KernelError, translate
from aseba_vm.kernel.types import Floats
from tests.aseba_vm.kernel import samples
from thymio_sim_ros.sim.kernel.memory import KernelMemory

MEMORY = 4096


def both(kernel: Callable[..., None], *arguments: Any, room: tuple[int, type[np.generic]]) -> tuple[Any, Any]:
    """What a kernel leaves in its last argument, an array of zeros: run by Python, and compiled."""
    memory = KernelMemory(MEMORY)
    shared = []
    for argument in arguments:
        if isinstance(argument, np.ndarray):
            copy = memory.array(argument.shape, argument.dtype.type)
            copy[:] = argument
            shared.append(copy)
        else:
            shared.append(argument)
    mine, compiled = np.zeros(*room), memory.array(*room)
    kernel(*arguments, mine)
    memory.bind(kernel, *shared, compiled)()
    return mine.tolist(), compiled.tolist()


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("kernel", [samples.arithmetic, samples.loops])
def test_floats_come_out_bit_for_bit(kernel: Callable[..., None], seed: int) -> None:
    dice = random.Random(seed)
    given = np.array([dice.uniform(-2, 2) if kernel is samples.arithmetic else dice.random() for _ in range(8)])
    mine, compiled = both(kernel, given, room=(9, np.float64))
    assert compiled == mine
    assert any(mine)


def test_halves_are_rounded_to_even() -> None:
    found = [both(samples.arithmetic, np.array([half, 0.0]), room=(9, np.float64)) for half in (0.125, 0.375, -0.625)]
    assert [compiled[8] for _, compiled in found] == [mine[8] for mine, _ in found] == [0.0, 2.0, -2.0]


@pytest.mark.parametrize("a", [-7, 0, 5])
@pytest.mark.parametrize("b", [-9, 3])
def test_integers_come_out_alike(a: int, b: int) -> None:
    mine, compiled = both(samples.integers, np.array([a, b], dtype=np.int32), room=(8, np.int32))
    assert compiled == mine


@pytest.mark.parametrize("a", [-1.0, 0.25, 0.5, 1.0])
@pytest.mark.parametrize("b", [0.25, 0.75, 3.0])
def test_conditions_come_out_alike(a: float, b: float) -> None:
    mine, compiled = both(samples.logic, np.array([a, b]), room=(5, np.int32))
    assert compiled == mine


def test_limits_of_a_loop_are_those_at_its_begin() -> None:
    mine, compiled = both(samples.nested, room=(9, np.int32))
    assert compiled == mine == [11, 12, 22, 0, 0, 0, 0, 0, 0]


def test_words_have_no_sign() -> None:
    given = np.array([65535, 65535], dtype=np.uint16)
    memory = KernelMemory(MEMORY)
    shared, found = memory.array(2, np.uint16), memory.array(2, np.uint16)
    shared[:] = given
    memory.bind(samples.words, shared, found)()
    assert found.tolist() == [0, 65535]


def test_numbers_are_handed_over_as_they_are() -> None:
    assert both(samples.choose, 3, 0.1, room=(1, np.float64)) == ([3 * 0.1], [3 * 0.1])


def test_a_kernel_may_return_before_its_end() -> None:
    assert both(samples.early, room=(1, np.float64)) == ([1.0], [1.0])


def test_infinity_is_a_number() -> None:
    mine, compiled = both(samples.beyond, room=(2, np.float64))
    assert compiled == mine == [float("inf"), -float("inf")]


def with_text(found: Floats) -> None:
    found[0] = "much"


def with_list(found: Floats) -> None:
    found[0] = sum([1.0, 2.0])


def with_float_index(found: Floats) -> None:
    found[found[0]] = 1.0


def with_other_type(found: Floats) -> None:
    number = 1
    number = 1.5
    found[0] = number


def with_unknown_name(found: Floats) -> None:
    found[0] = MEMORY.bit_length


@pytest.mark.parametrize("kernel", [with_text, with_list, with_float_index, with_other_type, with_unknown_name])
def test_what_kernels_have_not_is_refused_with_its_line(kernel: Callable[..., None]) -> None:
    with pytest.raises(KernelError, match=r"test_compiler, line \d+: kernels have no `"):
        translate([kernel])


def test_parameters_need_a_type_of_kernels() -> None:
    def kernel(found: list) -> None:  # type: ignore[type-arg]  # what is refused
        found[0] = 1

    with pytest.raises(KernelError, match="parameter found is list, expected int, float, array or record"):
        translate([kernel])


def test_records_come_out_alike() -> None:
    found = []
    for is_compiled in (False, True):
        memory = KernelMemory(MEMORY, is_compiled=is_compiled)
        points, sums = samples.Points(memory, 3), memory.array(3, np.float64)
        points.x[:] = (0.5, -1.5, 3.0)
        visit_all = memory.bind(samples.visit_all, points, sums)
        visit_all()
        visit_all()
        found.append((points.x.tolist(), points.visits.tolist(), sums.tolist()))
    assert found == [([2.0, -6.0, 12.0], [2, 2, 2], [4.0, -4.0, 14.0])] * 2


def test_another_record_is_refused() -> None:
    class Others(samples.Points):
        pass

    memory = KernelMemory(MEMORY)
    others, found = Others(memory, 1), memory.array(1, np.float64)
    with pytest.raises(KernelError, match="visit_all: points is Others, expected Points"):
        memory.bind(samples.visit_all, others, found)
