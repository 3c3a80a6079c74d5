"""Deque natives: ring buffers inside an array (docs/spec/aseba-bytecode-vm.md section 12).

Word 0 of the array is the number of elements, word 1 the start; the others are the ring. Moving words does not always
preserve the contents when the start is not 0. Programs and the reference rely on that, so it is reproduced. With an
invalid start, an insertion after the last element moves words around the ring up to 65536 times; this work is charged.
"""

from __future__ import annotations

from collections.abc import Mapping

from aseba_vm.machine.native_call import DequeFault, Native, NativeCall, wrap

_MOVE = 2
"""Cost of moving one word, in instructions."""


class _Deque:
    """The deque in argument 0 of a call. Raises DequeFault if the array is too small."""

    def __init__(self, call: NativeCall) -> None:
        self.call = call
        self.memory = call.memory
        self.address = call.addresses[0]
        self.length = call.sizes[0]
        if self.length < 3:
            raise DequeFault
        self.capacity = self.length - 2

    @property
    def count(self) -> int:
        return self.memory[self.address] & 0xFFFF

    @count.setter
    def count(self, value: int) -> None:
        self.memory[self.address] = wrap(value)

    @property
    def start(self) -> int:
        return self.memory[self.address + 1] & 0xFFFF

    @start.setter
    def start(self, value: int) -> None:
        self.memory[self.address + 1] = wrap(value)

    def place(self, position: int) -> int:
        """Return the address of a position in the ring."""
        return self.address + 2 + position % self.capacity

    def check_index(self, index: int) -> None:
        if not 0 <= index <= self.length - 3:
            raise DequeFault

    def move(self, target: int, last: int, delta: int) -> None:
        """Move words along the ring by ``delta``, from ``target`` up or down to ``last``.

        Moving down to 0 or below never ends in the reference, because ``target`` is unsigned there; here it is a fault.
        """
        if delta == 0:
            return
        step = 1 if delta > 0 else -1
        last = wrap(last)
        if last <= 0 and delta < 0:
            raise DequeFault
        target &= 0xFFFF
        words = last - target if delta > 0 else target - last
        if words > 2 * self.capacity:
            self.call.charge(_MOVE * words)
        # Indexes behave as in C: 16-bit unsigned target, remainder with the sign of the dividend. A negative one can
        # therefore address the words before the ring; addresses outside the memory are skipped.
        while target <= last if delta > 0 else target >= last:
            source = target + delta
            rest = source % self.capacity if source >= 0 else -(-source % self.capacity)
            origin = self.address + 2 + rest
            if 0 <= origin < len(self.memory):
                self.memory[self.place(target)] = self.memory[origin]
            target = (target + step) & 0xFFFF

    def insert(self, words: list[int], source: int, index: int) -> None:
        size = len(words)
        count, start, capacity = self.count, self.start, self.capacity
        if size > capacity - count:
            raise DequeFault
        if index < count // 2:
            start = capacity - size if start == 0 else (start - size + capacity) % capacity
            self.start = start
            self.move(start, index - 1 + size - 1, size)
        else:
            self.move(start + count + size - 1, start + index + size, -size)
        for offset in range(size):
            self.memory[self.place(start + index + offset)] = self.memory[source + offset]
        self.count = count + size

    def erase(self, index: int, size: int) -> None:
        count, start = self.count, self.start
        if size > count - index:
            raise DequeFault
        if index < count // 2:
            self.move(start + index + size - 1, start + size, -size)
            self.start = (start + size) % self.capacity
        else:
            self.move(start + index, start + count - 1 - size, size)
        self.count = count - size

    def get(self, call: NativeCall, argument: int, index: int) -> None:
        size, target = call.sizes[argument], call.addresses[argument]
        if size > self.count - index:
            raise DequeFault
        start = self.start + index
        for offset in range(size):
            self.memory[target + offset] = self.memory[self.place(start + offset)]

    def set(self, call: NativeCall, argument: int, index: int) -> None:
        size, source = call.sizes[argument], call.addresses[argument]
        if size > self.count - index:
            raise DequeFault
        start = self.start + index
        for offset in range(size):
            self.memory[self.place(start + offset)] = self.memory[source + offset]


def _size(call: NativeCall) -> None:
    call.write(1, [call.value(0)])


def _get(call: NativeCall) -> None:
    deque, index = _Deque(call), call.value(2)
    deque.check_index(index)
    deque.get(call, 1, index)


def _set(call: NativeCall) -> None:
    deque, index = _Deque(call), call.value(2)
    deque.check_index(index)
    deque.set(call, 1, index)


def _insert(call: NativeCall) -> None:
    deque, index = _Deque(call), call.value(2)
    deque.check_index(index)
    deque.insert(call.read(1), call.addresses[1], index)


def _erase(call: NativeCall) -> None:
    deque, index = _Deque(call), call.value(1)
    deque.check_index(index)
    deque.erase(index, call.value(2) & 0xFFFF)


def _push_front(call: NativeCall) -> None:
    _Deque(call).insert(call.read(1), call.addresses[1], 0)


def _push_back(call: NativeCall) -> None:
    deque = _Deque(call)
    deque.insert(call.read(1), call.addresses[1], deque.count)


def _pop(call: NativeCall, index: int) -> None:
    """Get and erase; erase runs even if get failed."""
    deque = _Deque(call)
    try:
        deque.get(call, 1, index)
    except DequeFault as fault:
        call.report(fault)
    deque.erase(index, call.sizes[1])


def _pop_front(call: NativeCall) -> None:
    _pop(call, 0)


def _pop_back(call: NativeCall) -> None:
    _pop(call, (_Deque(call).count - call.sizes[1]) & 0xFFFF)


DEQUE_NATIVES: Mapping[str, Native] = {
    "deque.size": _size,
    "deque.get": _get,
    "deque.set": _set,
    "deque.insert": _insert,
    "deque.erase": _erase,
    "deque.push_front": _push_front,
    "deque.push_back": _push_back,
    "deque.pop_front": _pop_front,
    "deque.pop_back": _pop_back,
}
