"""Kernels on integers, with arrays at fixed places and tables, called or made a part of their caller."""

from __future__ import annotations

import ctypes
import random
from collections.abc import Callable, Sequence
from typing import Any

import pytest

from aseba_vm.kernel.compiler import KernelError, KernelModule, Place
from aseba_vm.kernel.integers import floor_log2, quotient, remainder, wrap, wrap32
from aseba_vm.kernel.specialization import MAX_ITERATIONS
from aseba_vm.kernel.types import Ints, Shorts, kernel
from aseba_vm.kernel.wasm_runtime import WasmRuntime, is_usable

pytestmark = pytest.mark.skipif(not is_usable(), reason="wasmtime does not work here")

WORDS = 40
PLACES = {"memory": Place(0, WORDS), "count": Place(0x100, 1)}
TABLES = 0x200
SQUARES = tuple(number * number - 5 for number in range(20))
LIMITS = (0, 1, -1, 2, 7, -7, 32767, -32768)


@kernel
def integer_functions(memory: Shorts, a: int, b: int) -> int:
    """Every function of integers."""
    memory[0] = wrap(quotient(a, b))
    memory[1] = wrap(remainder(a, b))
    memory[2] = min(a, b)
    memory[3] = max(a, b)
    memory[4] = wrap(abs(a))
    memory[5] = wrap(a ^ b)
    memory[6] = floor_log2(a)
    memory[7] = wrap(wrap32(a * b * 3) >> 4)
    return wrap(a * b)


@kernel
def table_entry(memory: Shorts, index: int) -> int:
    return SQUARES[index] + SQUARES[index + 1] - len(memory)


@kernel
def shifted_sum(memory: Shorts, count: Ints, target: int, source: int, size: int) -> int:
    """Read and write the same words, and call another kernel."""
    total = 0
    for i in range(size):
        if memory[source + i] < 0:
            return -1
        memory[target + i] = wrap(memory[source + i] + i)
        total = total + counted(count, memory[target + i])
    return total


@kernel
def counted(count: Ints, value: int) -> int:
    count[0] = count[0] + 1
    return value * count[0]


@kernel
def halved(memory: Shorts, start: int) -> int:
    value = start
    while value > 3:
        value = value >> 1
        memory[value] = value
    return value


@kernel
def renamed(memory: Shorts, count: Ints, start: int) -> int:
    return table_of(count, start)


@kernel
def table_of(memory: Ints, index: int) -> int:
    return memory[index]


def compiled(module: KernelModule, text: str, locals_: dict[str, str]) -> tuple[Callable[[], int], Any, Any]:
    """A function that evaluates a text, and the words of `memory` and `count` that it works on."""
    names = "".join(f"(local {name} {kind})" for name, kind in locals_.items())
    source = f"""(module (memory (export "memory") 1) {module.text()}
      (func (export "run") (result i32) {names} {text}))"""
    runtime = WasmRuntime.get()
    store = runtime.wasmtime.Store(runtime.engine)
    exports = runtime.wasmtime.Instance(store, runtime.compile(source), []).exports(store)
    base = ctypes.addressof(exports["memory"].data_ptr(store).contents)
    memory = (ctypes.c_int16 * WORDS).from_address(base)
    count = (ctypes.c_int32 * 1).from_address(base + PLACES["count"].address)
    return lambda: exports["run"](store), memory, count


def both(function: Callable[..., int], words: Sequence[int], *arguments: int) -> list[Any]:
    """What a kernel returns and leaves: run by Python, called, and made a part of its caller."""
    has_count = "count" in function.__annotations__
    memory, count = list(words), [0]
    found = [(function(memory, *([count] if has_count else []), *arguments), memory, count)]
    called = KernelModule(PLACES, TABLES)
    called.use(function)
    numbers = " ".join(f"(i32.const {number})" for number in arguments)
    inlined = KernelModule(PLACES, TABLES)
    text, names, result = inlined.call(function, arguments)
    assert result in (None, found[0][0])
    for module, code, locals_ in ((called, f"(call ${function.__name__} {numbers})", {}), (inlined, text, names)):
        run, memory, count = compiled(module, code, dict(locals_))
        memory[:] = words
        found.append((run(), list(memory), list(count)))
    return found


@pytest.mark.parametrize("a", LIMITS)
@pytest.mark.parametrize("b", [number for number in LIMITS if number])
def test_integers_come_out_alike(a: int, b: int) -> None:
    python, called, inlined = both(integer_functions, [0] * WORDS, a, b)
    assert python == called == inlined


@pytest.mark.parametrize("index", [0, 7, 18])
def test_tables_and_lengths_are_those_of_python(index: int) -> None:
    python, called, inlined = both(table_entry, [0] * WORDS, index)
    assert python == called == inlined


@pytest.mark.parametrize("size", [0, 1, 4, MAX_ITERATIONS, MAX_ITERATIONS + 1])
def test_words_that_overlap_are_read_and_written_in_order(size: int) -> None:
    dice = random.Random(size)
    words = [dice.randrange(30000) for _ in range(WORDS)]
    for target, source in ((1, 0), (0, 1), (3, 3)):
        python, called, inlined = both(shifted_sum, words, target, source, size)
        assert python == called == inlined
    words[2] = -5
    python, called, inlined = both(shifted_sum, words, 4, 0, size)
    assert python == called == inlined


def test_short_loops_are_unrolled() -> None:
    for size, is_unrolled in ((MAX_ITERATIONS, True), (MAX_ITERATIONS + 1, False)):
        call = KernelModule(PLACES, TABLES).call(shifted_sum, (1, 0, size))
        assert ("(loop" not in call.text) == is_unrolled
        assert "$inlined1.total" in call.locals


def test_a_kernel_with_a_loop_that_ends_on_a_condition_is_called() -> None:
    assert KernelModule(PLACES, TABLES).call(halved, (40,)) == ("(call $halved (i32.const 40))", {}, None)
    python, called, inlined = both(halved, [0] * WORDS, 40)
    assert python == called == inlined


def test_an_array_at_a_fixed_place_has_one_name() -> None:
    module = KernelModule(PLACES, TABLES)
    module.use(renamed)
    with pytest.raises(KernelError, match="kernels have no `count`"):
        module.text()


def test_tables_need_room() -> None:
    module = KernelModule(PLACES)
    module.use(table_entry)
    with pytest.raises(KernelError, match=r"kernels have no `SQUARES\[index\]`"):
        module.text()
