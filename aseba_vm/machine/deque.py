"""Deque natives: ring buffers inside an array (docs/spec/aseba-bytecode-vm.md section 12).

Word 0 of the array is the number of elements, word 1 the start; the others are the ring. Moving words does not always
preserve the contents when the start is not 0. Programs and the reference rely on that, so it is reproduced. With an
invalid start, an insertion after the last element moves words around the ring up to 65536 times; this work is charged.
Changes made before a fault remain.
"""

from __future__ import annotations

from aseba_vm.kernel.integers import remainder, wrap
from aseba_vm.kernel.types import Ints, Shorts, kernel
from aseba_vm.machine.native_faults import DEQUE, DEQUE_TWICE, OK

_MOVE = 2
"""Cost of moving one word, in instructions."""


@kernel
def deque_size(memory: Shorts, queue: int, destination: int, length: int) -> int:
    memory[destination] = memory[queue]
    return OK


@kernel
def deque_get(memory: Shorts, queue: int, destination: int, index: int, length: int, size: int) -> int:
    if not 0 <= memory[index] <= length - 3:
        return DEQUE
    return get_words(memory, queue, destination, memory[index], length, size)


@kernel
def deque_set(memory: Shorts, queue: int, source: int, index: int, length: int, size: int) -> int:
    first = memory[index]
    if not 0 <= first <= length - 3 or size > (memory[queue] & 0xFFFF) - first:
        return DEQUE
    start = (memory[queue + 1] & 0xFFFF) + first
    for offset in range(size):
        memory[ring_place(queue, length, start + offset)] = memory[source + offset]
    return OK


@kernel
def deque_insert(memory: Shorts, cost: Ints, queue: int, source: int, index: int, length: int, size: int) -> int:
    if not 0 <= memory[index] <= length - 3:
        return DEQUE
    return insert_words(memory, cost, queue, source, memory[index], length, size)


@kernel
def deque_erase(memory: Shorts, cost: Ints, queue: int, index: int, count: int, length: int) -> int:
    if not 0 <= memory[index] <= length - 3:
        return DEQUE
    return erase_words(memory, cost, queue, memory[index], length, memory[count] & 0xFFFF)


@kernel
def deque_push_front(memory: Shorts, cost: Ints, queue: int, source: int, length: int, size: int) -> int:
    return insert_words(memory, cost, queue, source, 0, length, size)


@kernel
def deque_push_back(memory: Shorts, cost: Ints, queue: int, source: int, length: int, size: int) -> int:
    return insert_words(memory, cost, queue, source, memory[queue] & 0xFFFF, length, size)


@kernel
def deque_pop_front(memory: Shorts, cost: Ints, queue: int, destination: int, length: int, size: int) -> int:
    return pop_words(memory, cost, queue, destination, 0, length, size)


@kernel
def deque_pop_back(memory: Shorts, cost: Ints, queue: int, destination: int, length: int, size: int) -> int:
    return pop_words(memory, cost, queue, destination, (memory[queue] - size) & 0xFFFF, length, size)


@kernel
def ring_place(queue: int, length: int, position: int) -> int:
    """The address of a position in the ring, which is not negative."""
    if position < length - 2:
        return queue + 2 + position  # a division is slow
    return queue + 2 + remainder(position, length - 2)


@kernel
def get_words(memory: Shorts, queue: int, destination: int, index: int, length: int, size: int) -> int:
    if length < 3 or size > (memory[queue] & 0xFFFF) - index:
        return DEQUE
    start = (memory[queue + 1] & 0xFFFF) + index
    for offset in range(size):
        memory[destination + offset] = memory[ring_place(queue, length, start + offset)]
    return OK


@kernel
def pop_words(memory: Shorts, cost: Ints, queue: int, destination: int, index: int, length: int, size: int) -> int:
    """Read elements and erase them; they are erased even if they cannot be read."""
    if length < 3:
        return DEQUE
    fault = get_words(memory, queue, destination, index, length, size)
    second = erase_words(memory, cost, queue, index, length, size)
    if fault != OK and second != OK:
        return DEQUE_TWICE
    return fault + second


@kernel
def insert_words(memory: Shorts, cost: Ints, queue: int, source: int, index: int, length: int, size: int) -> int:
    count = memory[queue] & 0xFFFF
    start = memory[queue + 1] & 0xFFFF
    capacity = length - 2
    if length < 3 or size > capacity - count:
        return DEQUE
    if index < count >> 1:
        start = capacity - size if start == 0 else remainder(start - size + capacity, capacity)
        memory[queue + 1] = wrap(start)
        fault = move_words(memory, cost, queue, length, start, index + size - 2, size)
    else:
        fault = move_words(memory, cost, queue, length, start + count + size - 1, start + index + size, -size)
    if fault != OK:
        return fault
    for offset in range(size):
        memory[ring_place(queue, length, start + index + offset)] = memory[source + offset]
    memory[queue] = wrap(count + size)
    return OK


@kernel
def erase_words(memory: Shorts, cost: Ints, queue: int, index: int, length: int, size: int) -> int:
    count = memory[queue] & 0xFFFF
    start = memory[queue + 1] & 0xFFFF
    if length < 3 or size > count - index:
        return DEQUE
    if index < count >> 1:
        fault = move_words(memory, cost, queue, length, start + index + size - 1, start + size, -size)
        if fault == OK:
            memory[queue + 1] = wrap(remainder(start + size, length - 2))
    else:
        fault = move_words(memory, cost, queue, length, start + index, start + count - 1 - size, size)
    if fault == OK:
        memory[queue] = wrap(count - size)
    return fault


@kernel
def move_words(memory: Shorts, cost: Ints, queue: int, length: int, first: int, last: int, distance: int) -> int:
    """Move words along the ring by `distance`, from position `first` up or down to `last`.

    Moving down to 0 or below never ends in the reference, because positions are unsigned there; here it is a fault.
    """
    if distance == 0:
        return OK
    step = 1 if distance > 0 else -1
    end = wrap(last)
    if end <= 0 and distance < 0:
        return DEQUE
    target = first & 0xFFFF
    if (end - target) * step > 2 * (length - 2):
        cost[0] = cost[0] + _MOVE * (end - target) * step
    # Positions behave as in C: 16-bit unsigned target, remainder with the sign of the dividend. A negative one can
    # therefore be that of the words before the ring; addresses outside the memory are skipped.
    while (end - target) * step >= 0:
        origin = queue + 2 + remainder(target + distance, length - 2)
        if 0 <= origin < len(memory):
            memory[ring_place(queue, length, target)] = memory[origin]
        target = (target + step) & 0xFFFF
    return OK
