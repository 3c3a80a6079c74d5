"""The memory and imports that the WebAssembly modules of one machine share.

The variables of the machine live in this memory, so nothing is copied between Python and translated code. The constants
below are byte addresses in it.
"""

from __future__ import annotations

import ctypes
import struct
import weakref
from collections.abc import Callable, MutableSequence
from typing import Any, NamedTuple

from aseba_vm.jit.host import Run, TranslatedMachine
from aseba_vm.kernel.wasm_calls import make_caller, make_import
from aseba_vm.kernel.wasm_runtime import WasmRuntime

VARIABLES = 0
BRANCHES = 0x20000
"""Edge flags of the branches, one word each."""
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
"""Native call: number (or FAULTED plus the fault), address, number of popped words; then the result."""
STACK = EXIT + 64
"""Words to push on exit, four bytes each."""
TABLES = 0x58000
"""Lookup tables of natives."""
ARGUMENTS = 0x60000
"""Words that a native pops, four bytes each."""
EVENTS = 0x70000
"""Event buffer: number and count of each event, then its words."""
PAGES = 8

_EVENTS_SIZE = PAGES * 0x10000 - EVENTS
FAULTED = 0x10000

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
(func $native (param $number i32) (param $pc i32) (param $count i32) (result i32)
  (i32.store (i32.const {REQUEST}) (local.get $number))
  (i32.store (i32.const {REQUEST + 4}) (local.get $pc))
  (i32.store (i32.const {REQUEST + 8}) (local.get $count))
  (call $request)
  (i32.load (i32.const {REQUEST + 12})))
"""
"""Beginning of every module."""


class WasmCode(NamedTuple):
    """A module, and whether it uses the random number generator."""

    module: Any
    is_random: bool


class WasmHost:
    """The memory of one machine and the functions that its modules may call."""

    def __init__(self, machine: TranslatedMachine) -> None:
        """Move the variables of a machine into a new WebAssembly memory."""
        runtime = WasmRuntime.get()
        wasmtime = runtime.wasmtime
        self._wasmtime = wasmtime
        self._machine = machine
        self._store = wasmtime.Store(runtime.engine)
        memory = wasmtime.Memory(self._store, wasmtime.MemoryType(wasmtime.Limits(PAGES, PAGES)))
        self._base = ctypes.addressof(memory.data_ptr(self._store).contents)
        self._request = self._array(ctypes.c_int32, REQUEST, 4)
        self._arguments = self._array(ctypes.c_int32, ARGUMENTS, (EVENTS - ARGUMENTS) // 4)
        self._random = self._array(ctypes.c_uint32, RANDOM, 1)
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
        self._is_random = False
        self.edges: MutableSequence[int] = []
        self._is_open = True
        machine.variables.move_to(self._array(ctypes.c_int16, VARIABLES, len(machine.variables)), self)
        runtime.register(self)

    def close(self) -> None:
        """Move the variables back and free the memory."""
        if self._is_open:
            self._is_open = False
            self._machine.variables.move_back()
            self.edges = self.edges[:]
            self._store.close()

    def reserve_edges(self, branches: int) -> None:
        """Place the edge flags of a program with this number of branches."""
        self.edges = self._array(ctypes.c_int16, BRANCHES, branches)

    def instantiate(self, code: WasmCode) -> Run:
        """Return the function of a module for this machine."""
        run = self._wasmtime.Instance(self._store, code.module, self._imports).exports(self._store)["run"]
        call = make_caller(self._wasmtime, self._store, run)
        budget, exit_area, unpack = self._budget, self._exit, _EXIT_FORMAT.unpack_from

        def run_module(left: int) -> tuple[int, int, int, Any]:
            budget[0] = left
            call()
            found: tuple[int, int, int, int] = unpack(exit_area)
            return self._with_stack(found) if found[3] else found

        def run_random(left: int) -> tuple[int, int, int, Any]:
            self._is_random = True
            self._random[0] = self._machine.random_state
            found = run_module(left)
            self._machine.random_state = self._random[0]
            self._is_random = False
            return found

        return run_random if code.is_random else run_module

    def _call_native(self) -> None:
        """Call a native, or report a fault of a translated one, for translated code."""
        if self._emitted[0]:
            self._flush_events()
        number, pc, count = self._request[:3]
        if number >= FAULTED:
            self._machine.stop_on_translated_fault(pc, number - FAULTED)
            return
        if self._is_random:
            self._machine.random_state = self._random[0]
        self._request[3] = self._machine.call_native(number, pc, tuple(self._arguments[:count]))
        if self._is_random:
            self._random[0] = self._machine.random_state

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
            self._machine.emit(number, struct.unpack_from(f"<{count}h", self._events, at + 4))
            at += 4 + 2 * count

    def _array(self, kind: Any, place: int, size: int) -> Any:
        return (kind * size).from_address(self._base + place)


def _weak_call(this: weakref.ref[WasmHost], method: Callable[[WasmHost], None]) -> Callable[[], None]:
    """Return a function that calls a method without keeping the host alive."""

    def call() -> None:
        host = this()
        if host is not None:
            method(host)

    return call
