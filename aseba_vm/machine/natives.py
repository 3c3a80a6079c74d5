"""Standard natives (docs/spec/aseba-bytecode-vm.md section 12): one kernel each, for Python and for WebAssembly.

A kernel takes the variable memory, then what it needs of the state of the random number generator and of the cost of
the call, then the words that a call pops: the addresses of the arguments, and the sizes that the caller pushes. It
returns `OK` or the number of a fault. Elements are processed in index order, and each result is stored before the next
element is read, so overlapping arguments behave as specified.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from aseba_vm.kernel.integers import quotient, wrap, wrap32
from aseba_vm.kernel.signatures import parameters
from aseba_vm.kernel.types import Ints, Kernel, Shorts, kernel
from aseba_vm.machine import deque
from aseba_vm.machine.fixed_point_trigonometry import arctangent, cosine, sine
from aseba_vm.machine.native_call import Native, NativeCall
from aseba_vm.machine.native_faults import DIVISION, FAULTS, OK, SQUARE_ROOT
from aseba_vm.target import NativeFunction
from aseba_vm.targets import THYMIO_II

RANDOM_FACTOR, RANDOM_STEP = 25173, 13849
"""Constants of the random number generator."""


@kernel
def math_copy(memory: Shorts, target: int, source: int, size: int) -> int:
    for i in range(size):
        memory[target + i] = memory[source + i]
    return OK


@kernel
def math_fill(memory: Shorts, target: int, source: int, size: int) -> int:
    value = memory[source]
    for i in range(size):
        memory[target + i] = value
    return OK


@kernel
def math_addscalar(memory: Shorts, target: int, source: int, scalar: int, size: int) -> int:
    value = memory[scalar]
    for i in range(size):
        memory[target + i] = wrap(memory[source + i] + value)
    return OK


@kernel
def math_add(memory: Shorts, target: int, left: int, right: int, size: int) -> int:
    for i in range(size):
        memory[target + i] = wrap(memory[left + i] + memory[right + i])
    return OK


@kernel
def math_sub(memory: Shorts, target: int, left: int, right: int, size: int) -> int:
    for i in range(size):
        memory[target + i] = wrap(memory[left + i] - memory[right + i])
    return OK


@kernel
def math_mul(memory: Shorts, target: int, left: int, right: int, size: int) -> int:
    for i in range(size):
        memory[target + i] = wrap(memory[left + i] * memory[right + i])
    return OK


@kernel
def math_div(memory: Shorts, target: int, left: int, right: int, size: int) -> int:
    for i in range(size):
        divisor = memory[right + i]
        if divisor == 0:
            return DIVISION
        memory[target + i] = wrap(quotient(memory[left + i], divisor))
    return OK


@kernel
def math_min(memory: Shorts, target: int, left: int, right: int, size: int) -> int:
    for i in range(size):
        memory[target + i] = min(memory[left + i], memory[right + i])
    return OK


@kernel
def math_max(memory: Shorts, target: int, left: int, right: int, size: int) -> int:
    for i in range(size):
        memory[target + i] = max(memory[left + i], memory[right + i])
    return OK


@kernel
def math_clamp(memory: Shorts, target: int, source: int, low: int, high: int, size: int) -> int:
    for i in range(size):
        value = memory[source + i]
        least = memory[low + i]
        most = memory[high + i]
        memory[target + i] = most if value > most else max(value, least)  # the order matters if least > most
    return OK


@kernel
def math_dot(memory: Shorts, target: int, left: int, right: int, shift: int, size: int) -> int:
    total = 0
    for i in range(size):
        total = total + memory[left + i] * memory[right + i]
    count = memory[shift]
    memory[target] = 0 if count > 32 else wrap(wrap32(total) >> (count & 31))
    return OK


@kernel
def math_stat(memory: Shorts, source: int, low: int, high: int, mean: int, size: int) -> int:
    if size == 0:
        return OK
    value = memory[source]
    memory[low] = value
    memory[high] = value
    total = 0
    for i in range(size):
        value = memory[source + i]
        if value < memory[low]:
            memory[low] = value
        if value > memory[high]:
            memory[high] = value
        total = total + value
    memory[mean] = wrap(quotient(wrap32(total), size))
    return OK


@kernel
def math_argbounds(memory: Shorts, source: int, at_low: int, at_high: int, size: int) -> int:
    low = 32767
    high = -32768
    for i in range(size):
        value = memory[source + i]
        if value < low:
            low = value
            memory[at_low] = wrap(i)
        if value > high:
            high = value
            memory[at_high] = wrap(i)
    return OK


@kernel
def math_sort(memory: Shorts, source: int, size: int) -> int:
    """Shell sort: insertion sort with gaps of …, 13, 4, 1 words."""
    gap = 1
    while gap < size:
        gap = 3 * gap + 1
    while gap > 0:
        for i in range(source + gap, source + size):
            value = memory[i]
            hole = i
            while hole >= source + gap:
                other = memory[hole - gap]
                if other <= value:
                    break
                memory[hole] = other
                hole = hole - gap
            memory[hole] = value
        gap = quotient(gap - 1, 3)
    return OK


@kernel
def math_muldiv(memory: Shorts, target: int, left: int, right: int, divisor: int, size: int) -> int:
    for i in range(size):
        value = memory[divisor + i]
        if value == 0:
            return DIVISION
        memory[target + i] = wrap(quotient(memory[left + i] * memory[right + i], value))
    return OK


@kernel
def math_atan2(memory: Shorts, target: int, y: int, x: int, size: int) -> int:
    for i in range(size):
        memory[target + i] = wrap(arctangent(memory[y + i], memory[x + i]))
    return OK


@kernel
def math_sin(memory: Shorts, target: int, source: int, size: int) -> int:
    for i in range(size):
        memory[target + i] = sine(memory[source + i])
    return OK


@kernel
def math_cos(memory: Shorts, target: int, source: int, size: int) -> int:
    for i in range(size):
        memory[target + i] = cosine(memory[source + i])
    return OK


@kernel
def math_rot2(memory: Shorts, target: int, source: int, angle: int) -> int:
    x = memory[source]
    y = memory[source + 1]
    c = cosine(memory[angle])
    s = sine(memory[angle])
    memory[target] = wrap(wrap32(c * x - s * y) >> 15)
    memory[target + 1] = wrap(wrap32(c * y + s * x) >> 15)
    return OK


@kernel
def math_sqrt(memory: Shorts, target: int, source: int, size: int) -> int:
    for i in range(size):
        value = memory[source + i]
        if value < 0:
            return SQUARE_ROOT
        memory[target + i] = int(math.sqrt(value))
    return OK


@kernel
def math_rand(memory: Shorts, random: Ints, target: int, size: int) -> int:
    for i in range(size):
        random[0] = (RANDOM_FACTOR * random[0] + RANDOM_STEP) & 0xFFFF
        memory[target + i] = wrap(random[0])
    return OK


class StandardNative:
    """A standard native as the machine calls it: Python runs its kernel."""

    def __init__(self, kernel: Kernel, declared: NativeFunction) -> None:
        """Take a kernel and the parameters of the native that it implements."""
        self.kernel = kernel
        self._declared = declared
        names = parameters(kernel)[0]
        self._has_cost, self._is_random = "cost" in names, "random" in names

    def __call__(self, call: NativeCall) -> None:
        """Execute a call of a native with the same parameters. Raises NativeFault."""
        self._execute(call, call.popped)

    def adapted(self, call: NativeCall) -> None:
        """Execute a call of a native that declares other sizes. Raises NativeFault."""
        self._execute(call, (*call.addresses, *[call.sizes[index] for index in self._declared.free_sizes]))

    def _execute(self, call: NativeCall, words: Sequence[int]) -> None:
        if self._has_cost:
            cost = [0]
            result = self.kernel(call.memory, cost, *words)
            call.charge(cost[0])
        elif self._is_random:
            result = self.kernel(call.memory, call.machine.random, *words)
        else:
            result = self.kernel(call.memory, *words)
        if result != OK:
            raise FAULTS[result]()

    def fits(self, native: NativeFunction) -> bool:
        """Whether a native has the parameters of this one, so that the kernel can take the words of a call."""
        return [parameter.size for parameter in native.parameters] == [
            parameter.size for parameter in self._declared.parameters
        ]


def _standard_natives() -> dict[str, StandardNative]:
    """The natives that the Thymio II declares and that have a kernel: `math.add` is `math_add`."""
    kernels = {**globals(), **vars(deque)}
    return {
        native.name: StandardNative(kernels[name], native)
        for native in THYMIO_II.natives
        if (name := native.name.replace(".", "_", 1)) in kernels
    }


#: The standard natives by name.
NATIVES: Mapping[str, Native] = _standard_natives()
