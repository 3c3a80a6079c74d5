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
"""Entry: the budget (i64). Exit: the budget left (i64), address, kind, and number of stack words (i32 each)."""
RANDOM = EXIT + 28
"""State of the random number generator."""
INNER = EXIT + 32
"""Budget left when code exits inside a subroutine."""
REQUEST = EXIT + 40
"""Call of Python: its number in the module; 0 to execute it, or 1 plus the result of a translated native. Then 0 to
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
PAGES = 7

_EXIT_FORMAT = struct.Struct("<qiii")

IMPORTS = f"""
(import "" "request" (func $request))
(import "" "memory" (memory {PAGES} {PAGES}))
(func $python (param $call i32) (param $done i32) (result i32)
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


class EmitSite(NamedTuple):
    """An event that a program emits: its number, the address and the number of its words."""

    number: int
    address: int
    words: int


class WasmCode(NamedTuple):
    """A module and its calls of Python."""

    module: Any
    sites: tuple[CallSite | EmitSite, ...]


class TranslatedMachine(Protocol):
    """The part of a machine that translated code uses; none of these methods may raise."""

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


class Caller(Protocol):
    """Executes native calls and emits events for translated code; none of these methods may raise."""

    def prepare(self, site: CallSite | EmitSite) -> Callable[[Sequence[int]], int]:
        """The function that executes this call or emits this event.

        Its argument is an array that begins with the words that a call pops. It returns 0 to continue, 1 if translated
        code must exit, 2 if an argument is invalid and nothing was done.
        """

    def finish(self, site: CallSite, result: int, cost: int) -> None:
        """Account for a translated native that returned a fault, or added to its cost."""


class WasmHost:
    """The memory of one machine and the functions that its modules may call."""

    def __init__(self, machine: TranslatedMachine, caller: Caller) -> None:
        """Move the variables, edge flags and random state of a machine into a new WebAssembly memory."""
        runtime = WasmRuntime.get()
        wasmtime = runtime.wasmtime
        self._wasmtime = wasmtime
        self._machine = machine
        self._caller = caller
        self._store = wasmtime.Store(runtime.engine)
        # The memory has a fixed size, so that its address never changes, and Python's arrays can point into it.
        memory = wasmtime.Memory(self._store, wasmtime.MemoryType(wasmtime.Limits(PAGES, PAGES)))
        self._base = ctypes.addressof(memory.data_ptr(self._store).contents)
        self._request = self._array(ctypes.c_int32, REQUEST, 3)
        self._cost = self._array(ctypes.c_int32, COST, 1)
        self._arguments = self._array(ctypes.c_int32, ARGUMENTS, (PAGES * 0x10000 - ARGUMENTS) // 4)
        self._exit = memoryview(self._array(ctypes.c_ubyte, EXIT, _EXIT_FORMAT.size)).cast("B")
        self._budget = self._array(ctypes.c_int64, EXIT, 1)
        self._stack = self._array(ctypes.c_int32, STACK, (TABLES - STACK) // 4)
        # The store keeps its host functions alive; a strong reference would keep this object alive in a cycle.
        this = weakref.ref(self)
        self._imports = [make_import(wasmtime, self._store, lambda: _call_python(this)), memory]
        self._sites: tuple[CallSite | EmitSite, ...] = ()
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
        """The function of a module for this machine."""
        run = self._wasmtime.Instance(self._store, code.module, self._imports).exports(self._store)["run"]
        call = make_caller(self._wasmtime, self._store, run)
        budget, exit_area, unpack = self._budget, self._exit, _EXIT_FORMAT.unpack_from
        calls = [self._caller.prepare(site) for site in code.sites]

        def run_module(left: int) -> tuple[int, int, int, Any]:
            budget[0] = left
            call()
            values: tuple[int, int, int, int] = unpack(exit_area)
            return self._with_stack(values) if values[3] else values

        def run_with_calls(left: int) -> tuple[int, int, int, Any]:
            self._sites, self._calls = code.sites, calls
            return run_module(left)

        return run_with_calls if calls else run_module

    def call_python(self) -> None:
        """Execute the request of translated code."""
        request = self._request
        number, done = request[0], request[1]
        if done:
            cost, self._cost[0] = self._cost[0], 0
            site = self._sites[number]
            assert isinstance(site, CallSite)
            self._caller.finish(site, done - 1, cost)
        else:
            request[2] = self._calls[number](self._arguments)

    def _with_stack(self, values: tuple[int, int, int, int]) -> tuple[int, int, int, Any]:
        """An exit with the words to push."""
        left, pc, kind, count = values
        return left, pc, kind, tuple(self._stack[:count])

    def _array(self, kind: Any, place: int, size: int) -> Any:
        return (kind * size).from_address(self._base + place)

    def _moved(self, words: Sequence[int], kind: Any, place: int) -> Any:
        """A copy of words in the memory."""
        array = self._array(kind, place, len(words))
        array[:] = words[:]
        return array


def _call_python(this: weakref.ref[WasmHost]) -> None:
    """Execute the request of a host without keeping it alive."""
    host = this()
    if host is not None:
        host.call_python()
