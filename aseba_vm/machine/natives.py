"""Standard natives, one function each (docs/spec/aseba-bytecode-vm.md section 12).

Elements are processed in index order, and each result is stored before the next element is read, so overlapping
arguments behave as specified. The numbers of arguments are those of the declarations in the target.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import isqrt

from aseba_vm.machine.deque import DEQUE_NATIVES
from aseba_vm.machine.fixed_point_trigonometry import arctangent, cosine, sine
from aseba_vm.machine.native_call import DivisionFault, Native, NativeCall, NativeFault, wrap, wrap32

RANDOM_FACTOR, RANDOM_STEP = 25173, 13849
"""Constants of the random number generator (docs/spec/aseba-bytecode-vm.md section 12)."""

SQUARE_ROOT_FAULT = "sqrt-of-negative"
"""Reason of the fault for the square root of a negative number."""


def _elementwise(function: Callable[..., int]) -> Native:
    """Return a native that computes each element of argument 0 from the elements of the other arguments."""

    def native(call: NativeCall) -> None:
        memory = call.memory
        target, *sources = call.addresses
        for offset in range(call.sizes[0]):
            memory[target + offset] = wrap(function(*[memory[source + offset] for source in sources]))

    return native


def _quotient(numerator: int, denominator: int) -> int:
    if denominator == 0:
        raise DivisionFault
    quotient = abs(numerator) // abs(denominator)
    return quotient if (numerator < 0) == (denominator < 0) else -quotient


def _clamped(value: int, low: int, high: int) -> int:
    if value > high:
        return high
    return low if value < low else value  # the order matters when low is above high


def _square_root(value: int) -> int:
    if value < 0:
        raise NativeFault(SQUARE_ROOT_FAULT)
    return isqrt(value)


def _fill(call: NativeCall) -> None:
    value = call.value(1)
    for offset in range(call.sizes[0]):
        call.memory[call.addresses[0] + offset] = value


def _addscalar(call: NativeCall) -> None:
    target, source, _ = call.addresses
    scalar = call.value(2)
    for offset in range(call.sizes[0]):
        call.memory[target + offset] = wrap(call.memory[source + offset] + scalar)


def _dot(call: NativeCall) -> None:
    shift = call.value(3)
    total = sum(left * right for left, right in zip(call.read(1), call.read(2), strict=True))
    call.write(0, [0 if shift > 32 else wrap32(total) >> (shift & 31)])


def _stat(call: NativeCall) -> None:
    memory = call.memory
    source, low, high, mean = call.addresses
    size = call.sizes[0]
    if size == 0:
        return
    total = 0
    memory[low] = memory[high] = memory[source]
    for offset in range(size):
        value = memory[source + offset]
        memory[low] = min(memory[low], value)
        memory[high] = max(memory[high], value)
        total += value
    memory[mean] = wrap(_quotient(wrap32(total), size))


def _argbounds(call: NativeCall) -> None:
    memory = call.memory
    source, at_low, at_high = call.addresses
    low, high = 32767, -32768
    for offset in range(call.sizes[0]):
        value = memory[source + offset]
        if value < low:
            low = value
            memory[at_low] = wrap(offset)
        if value > high:
            high = value
            memory[at_high] = wrap(offset)


def _sort(call: NativeCall) -> None:
    call.write(0, sorted(call.read(0)))


def _rand(call: NativeCall) -> None:
    machine = call.machine
    for offset in range(call.sizes[0]):
        machine.random_state = (RANDOM_FACTOR * machine.random_state + RANDOM_STEP) & 0xFFFF
        call.memory[call.addresses[0] + offset] = wrap(machine.random_state)


def _rot2(call: NativeCall) -> None:
    x, y = call.read(1)
    angle = call.value(2)
    c, s = cosine(angle), sine(angle)
    call.write(0, [wrap32(c * x - s * y) >> 15, wrap32(c * y + s * x) >> 15])


#: The standard natives by name.
NATIVES: Mapping[str, Native] = {
    "math.copy": _elementwise(lambda value: value),
    "math.fill": _fill,
    "math.addscalar": _addscalar,
    "math.add": _elementwise(lambda left, right: left + right),
    "math.sub": _elementwise(lambda left, right: left - right),
    "math.mul": _elementwise(lambda left, right: left * right),
    "math.div": _elementwise(_quotient),
    "math.min": _elementwise(min),
    "math.max": _elementwise(max),
    "math.clamp": _elementwise(_clamped),
    "math.dot": _dot,
    "math.stat": _stat,
    "math.argbounds": _argbounds,
    "math.sort": _sort,
    "math.muldiv": _elementwise(lambda one, two, three: _quotient(wrap32(one * two), three)),
    "math.atan2": _elementwise(arctangent),
    "math.sin": _elementwise(sine),
    "math.cos": _elementwise(cosine),
    "math.rot2": _rot2,
    "math.sqrt": _elementwise(_square_root),
    "math.rand": _rand,
    **DEQUE_NATIVES,
}
