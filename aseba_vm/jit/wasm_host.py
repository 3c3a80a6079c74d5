"""The memory and imports that the WebAssembly modules of one machine share.

The variables, the edge flags and the state of the random number generator of the machine live in this memory, so
nothing is copied between Python and translated code. The constants below are byte addresses in it.
"""

from __future__ import annotations

import ctypes
import struct
import weakref
from collections.abc import Callable, MutableSequence, Sequence
from typing import Any, NamedTuple, Protocol

from aseba_vm.kernel.wasm_calls import make_caller, make_import
from aseba_vm.kernel.wasm_runtime import WasmRuntime
from aseba_vm.machine.code_memory import CodeMemory
from aseba_vm.machine.data_memory import Variables

VARIABLES = 0
EDGES = 0x20000
"""Edge flags, one word for each word of bytecode."""
EXIT = 0x40000
"""Entry: the budget (i64). Exit: the budget left (i64), address, kind, and number of stack words plus 4096 times the
bytes in the event buffer (i32 each).
"""
EMITTED = EXIT + 24
"""Number of bytes in the event buffer."""
RANDOM = EXIT + 28
"""State of the random number generator."""
INNER = EXIT + 32
"""Budget left when code exits inside a subroutine."""
REQUEST = EXIT + 40
"""Native call: number of the call in the module; 0 to execute it, or 1 plus the result if it was translated. Then 0 to
continue, 1 to exit, 2 if an argument is invalid and nothing was done.
"""
COST = EXIT + 52
"""Cost that a translated native adds to that of its call."""
STACK = EXIT + 64
"""Words to push on exit, four bytes each."""
TABLES = 0x58000
"""Tables that natives read."""
ARGUMENTS = 0x60000
"""Words that a native pops, four bytes each."""
EVENTS = 0x70000
"""Event buffer: number and count of each event, then its words."""
PAGES = 8

_EVENTS_SIZE = PAGES * 0x10000 - EVENTS

_EXIT_FORMAT = struct.Struct("<qiii")
_EVENT = struct.Struct("<HH")

EMIT = f"""
(func $emit (param $number i32) (param $address i32) (param $count i32) (local $at i32)
  (local.set $at (i32.load (i32.const {EMITTED})))
  (if (i32.gt_u (i32.add (local.get $at) (i32.shl (local.get $count) (i32.const 1))) (i32.const {_EVENTS_SIZE - 4}))
    (then (call $flush) (local.set $at (i32.const 0))))
  (i32.store16 offset={EVENTS} (local.get $at) (local.get $number))
  (i32.store16 offset={EVENTS + 2} (local.get $at) (local.get $count))
  (memory.copy (i32.add (local.get $at) (i32.const {EVENTS + 4}))
    (i32.shl (local.get $address) (i32.const 1)) (i32.shl (local.get $count) (i32.const 1)))
  (i32.store (i32.const {EMITTED})
    (i32.add (i32.add (local.get $at) (i32.const 4)) (i32.shl (local.get $count) (i32.const 1)))))
"""
"""Function that appends an event to the buffer, which it flushes first if it is full."""

IMPORTS = f"""
(import "" "request" (func $request))
(import "" "flush" (func $flush))
(import "" "memory" (memory {PAGES} {PAGES}))
(func $native (param $call i32) (param $done i32) (result i32)
  (i32.store (i32.const {REQUEST}) (local.get $call))
  (i32.store (i32.const {REQUEST + 4}) (local.get $done))
  (call $request)
  (i32.load (i32.const {REQUEST + 8})))
"""
"""Beginning of every module."""

Run = Callable[[int], tuple[int, int, int, Any]]
"""Run with a budget; return the budget left, the address, the kind of exit and the words to push (falsy if none)."""


class CallSite(NamedTuple):
    """A native call in a program: native, address, number of popped words, and these words if all are constant."""

    number: int
    pc: int
    words: int
    popped: tuple[int, ...] | None


class WasmCode(NamedTuple):
    """A module and its native calls."""

    module: Any
    calls: tuple[CallSite, ...]


class TranslatedMachine(Protocol):
    """What translated code needs of its machine; none of these methods may raise."""

    @property
    def variables(self) -> Variables:
        """The variables."""

    @property
    def code(self) -> CodeMemory:
        """The bytecode, whose edge flags are shared."""

    @property
    def random(self) -> MutableSequence[int]:
        """The state of the random number generator."""

    @random.setter
    def random(self, storage: MutableSequence[int]) -> None: ...


class NativeCaller(Protocol):
    """What executes native calls for translated code; none of these methods may raise."""

    def prepare(self, site: CallSite) -> Callable[[Sequence[int]], int]:
        """Return the function that executes a call, given an array that begins with the words it pops.

        It returns 0 to continue, 1 if translated code must exit, 2 if an argument is invalid and nothing was done.
        """

    def finish(self, site: CallSite, result: int, cost: int) -> None:
        """Account for a translated native that returned a fault, or added to its cost."""

    def emit(self, number: int, words: tuple[int, ...]) -> None:
        """Emit an event."""


class WasmHost:
    """The memory of one machine and the functions that its modules may call."""

    def __init__(self, machine: TranslatedMachine, caller: NativeCaller) -> None:
        """Move the variables, edge flags and random state of a machine into a new WebAssembly memory."""
        runtime = WasmRuntime.get()
        wasmtime = runtime.wasmtime
        self._wasmtime = wasmtime
        self._machine = machine
        self._caller = caller
        self._store = wasmtime.Store(runtime.engine)
        memory = wasmtime.Memory(self._store, wasmtime.MemoryType(wasmtime.Limits(PAGES, PAGES)))
        self._base = ctypes.addressof(memory.data_ptr(self._store).contents)
        self._request = self._array(ctypes.c_int32, REQUEST, 3)
        self._cost = self._array(ctypes.c_int32, COST, 1)
        self._arguments = self._array(ctypes.c_int32, ARGUMENTS, (EVENTS - ARGUMENTS) // 4)
        self._events = memoryview(self._array(ctypes.c_ubyte, EVENTS, _EVENTS_SIZE)).cast("B")
        self._emitted = self._array(ctypes.c_int32, EMITTED, 1)
        self._exit = memoryview(self._array(ctypes.c_ubyte, EXIT, _EXIT_FORMAT.size)).cast("B")
        self._budget = self._array(ctypes.c_int64, EXIT, 1)
        self._stack = self._array(ctypes.c_int32, STACK, (TABLES - STACK) // 4)
        # The store keeps its host functions alive; a strong reference would keep this object alive in a cycle.
        this = weakref.ref(self)
        self._imports = [
            make_import(wasmtime, self._store, _weak_call(this, WasmHost._call_native)),
            make_import(wasmtime, self._store, _weak_call(this, WasmHost._flush_events)),
            memory,
        ]
        self._sites: tuple[CallSite, ...] = ()
        self._calls: list[Callable[[Sequence[int]], int]] = []
        self._is_open = True
        machine.variables.move_to(self._array(ctypes.c_int16, VARIABLES, len(machine.variables)), self)
        machine.code.edges = self._moved(machine.code.edges, ctypes.c_int16, EDGES)
        machine.random = self._moved(machine.random, ctypes.c_int32, RANDOM)
        runtime.register(self)

    def close(self) -> None:
        """Move the state of the machine back and free the memory."""
        if self._is_open:
            self._is_open = False
            self._machine.variables.move_back()
            self._machine.code.edges = self._machine.code.edges[:]
            self._machine.random = self._machine.random[:]
            self._store.close()

    def instantiate(self, code: WasmCode) -> Run:
        """Return the function of a module for this machine."""
        run = self._wasmtime.Instance(self._store, code.module, self._imports).exports(self._store)["run"]
        call = make_caller(self._wasmtime, self._store, run)
        budget, exit_area, unpack = self._budget, self._exit, _EXIT_FORMAT.unpack_from
        calls = [self._caller.prepare(site) for site in code.calls]

        def run_module(left: int) -> tuple[int, int, int, Any]:
            budget[0] = left
            call()
            found: tuple[int, int, int, int] = unpack(exit_area)
            return self._with_stack(found) if found[3] else found

        def run_with_calls(left: int) -> tuple[int, int, int, Any]:
            self._sites, self._calls = code.calls, calls
            return run_module(left)

        return run_with_calls if calls else run_module

    def _call_native(self) -> None:
        """Call a native, or account for a translated one, for translated code."""
        if self._emitted[0]:
            self._flush_events()
        request = self._request
        number, done = request[0], request[1]
        if done:
            cost, self._cost[0] = self._cost[0], 0
            self._caller.finish(self._sites[number], done - 1, cost)
        else:
            request[2] = self._calls[number](self._arguments)

    def _with_stack(self, found: tuple[int, int, int, int]) -> tuple[int, int, int, Any]:
        """Flush the events and return the exit with the words to push."""
        left, pc, kind, count = found
        self._flush_events()
        return left, pc, kind, tuple(self._stack[: count & 0xFFF])

    def _flush_events(self) -> None:
        """Emit the events of the buffer in order."""
        end = self._emitted[0]
        self._emitted[0] = at = 0
        while at < end:
            number, count = _EVENT.unpack_from(self._events, at)
            self._caller.emit(number, struct.unpack_from(f"<{count}h", self._events, at + 4))
            at += 4 + 2 * count

    def _array(self, kind: Any, place: int, size: int) -> Any:
        return (kind * size).from_address(self._base + place)

    def _moved(self, words: Sequence[int], kind: Any, place: int) -> Any:
        """Return a copy of words in the memory."""
        array = self._array(kind, place, len(words))
        array[:] = words[:]
        return array


def _weak_call(this: weakref.ref[WasmHost], method: Callable[[WasmHost], None]) -> Callable[[], None]:
    """Return a function that calls a method without keeping the host alive."""

    def call() -> None:
        host = this()
        if host is not None:
            method(host)

    return call
