"""Arrays in the memory that kernels see."""

from __future__ import annotations

from _ctypes import CFuncPtr

import numpy as np
import pytest

from aseba_vm.kernel.compiler import KernelError
from tests.aseba_vm.kernel import samples
from thymio_sim_ros.sim.kernel.memory import KernelMemory


def test_arrays_lie_side_by_side_and_are_zero() -> None:
    memory = KernelMemory(1000)
    words, floats = memory.array(3, np.uint16), memory.array((2, 3), np.float64)
    words[:], floats[:] = 7, 1.5
    assert memory.array(4, np.int32).tolist() == [0, 0, 0, 0]
    assert words.tolist() == [7, 7, 7]
    assert floats.tolist() == [[1.5] * 3] * 2


def test_what_room_says_is_enough() -> None:
    shapes = [(3, np.uint16), ((5, 7), np.float64), (1, np.int32), (40000, np.float64)]
    memory = KernelMemory(sum(KernelMemory.room(*shape) for shape in shapes))
    assert [memory.array(*shape).size for shape in shapes] == [3, 35, 1, 40000]


def test_a_full_memory_says_so() -> None:
    with pytest.raises(MemoryError, match=r"an array of 9000: found 65536 free bytes, expected 72000"):
        KernelMemory(1000).array(9000, np.float64)


def test_arrays_of_another_memory_are_refused() -> None:
    memory = KernelMemory(1000, is_compiled=True)
    for array in (np.zeros(1), memory.array(2, np.int32), memory.array((2, 2), np.float64)[:, 0]):
        with pytest.raises(KernelError, match="expected a contiguous array of float64 in this memory"):
            memory.bind(samples.early, array)


def test_the_number_of_arguments_is_checked() -> None:
    with pytest.raises(KernelError, match="early: found 0 arguments, expected 1"):
        KernelMemory(1000).bind(samples.early)


def test_a_kernel_is_bound_as_often_as_robots_come_and_go() -> None:
    """A store of wasmtime takes ten thousand instances; a world in which robots came and went broke after hours."""
    memory = KernelMemory(1000)
    array = memory.array(2, np.float64)
    for _ in range(10_100):
        call = memory.bind(samples.early, array)
    call()


def test_a_bound_kernel_has_no_classes_of_its_own() -> None:
    """Only the collector frees classes, and it does not count what they keep outside Python."""
    memory = KernelMemory(1000)
    array = memory.array(2, np.float64)
    kept = [memory.bind(samples.early, array)]
    before = len(CFuncPtr.__subclasses__())
    kept += [memory.bind(samples.early, array) for _ in range(10)]
    assert len(CFuncPtr.__subclasses__()) == before


def test_memory_that_is_freed_and_allocated_again_is_zero() -> None:
    memory = KernelMemory(1000)
    memory.array(3, np.float64)
    used = memory.used
    memory.array(5, np.float64)[:] = 7.0
    memory.used = used
    assert memory.array(9, np.float64).tolist() == [0.0] * 9
