"""How fast events run: interpreted, translated, and on the reference's C machine where Debian's package is installed.

Each program runs an event again and again in turn on every engine; the figure is the median of the rounds, in millions
of instructions per second of processor time, and its ratio to the plain interpreter (and to the C machine, where
Debian's package `aseba` and cc are installed). All engines must end with the same variables.
"""

from __future__ import annotations

import argparse
import ctypes
import os
import shutil
import statistics
import subprocess
import tempfile
import time
from collections.abc import Callable
from functools import cache
from pathlib import Path

from aseba_vm import VirtualMachine, compile
from aseba_vm.jit.tiering import INTERPRETER, WASM
from aseba_vm.kernel.wasm_runtime import is_usable
from aseba_vm.targets import THYMIO_II
from benchmarks.lib.report import Goal, Report, Table

QUICK = {"rounds": 1, "seconds": 0.01, "words": [100]}

BEHAVIOUR = """
var speed = 200
var state
var i
var weights[7] = [-2, -1, 1, 1, 2, 0, 0]
var filtered[7]
var left
var right
var count
var lit
onevent prox
count++
left = speed
right = speed
for i in 0:6 do
  filtered[i] = (filtered[i] * 3 + prox.horizontal[i]) / 4
  left = left - filtered[i] * weights[i] / 16
  right = right + filtered[i] * weights[i] / 16
end
if filtered[2] > 2000 then
  state = 1
elseif filtered[0] > 1500 or filtered[4] > 1500 then
  state = 2
else
  state = 0
end
when state == 1 do
  lit = lit + 1
end
if state == 2 then
  left = left / 2
  right = right / 2
end
if left > 500 then left = 500 end
if left < -500 then left = -500 end
if right > 500 then right = 500 end
if right < -500 then right = -500 end
motor.left.target = left
motor.right.target = right
for i in 0:6 do
  weights[i] = (weights[i] * 15 + filtered[i] % 3) / 16
end
"""

PROGRAMS = {
    "arithmetic": """
        var i  var a  var b = 7
        onevent prox
        for i in 1:1000 do a = (a * 3 + b) % 1013 - i  b = (a ^ i) + (b >> 1) end""",
    "array": """
        var i  var t[50]  var s
        onevent prox
        for i in 0:999 do t[i % 50] = t[(i + 7) % 50] + i  s = s + t[i % 50] end""",
    "branchy": """
        var i  var a  var b  var c
        onevent prox
        for i in 0:999 do
          if a > b then b = b + 3 else a = a + 2 end
          when a > 1000 do c++ end
          if c == 5 or a < 0 then c = 0  a = 0  b = 0 end
        end""",
    "subroutines": """
        var i  var a  var b
        onevent prox
        for i in 0:999 do callsub one  callsub two end
        sub one
        a = a + i
        sub two
        if a > 100 then a = a - 100 end""",
    "natives": """
        var i  var t[8]  var u[8]  var d
        onevent prox
        for i in 0:199 do call math.fill(t, i)  call math.add(u, u, t)  call math.dot(d, u, t, 3) end""",
    "numbers": """
        var i  var a  var b  var c[2] = [3, 4]
        onevent prox
        for i in 1:200 do
          call math.sin(a, i)  call math.atan2(b, i, a)  call math.muldiv(a, i, b, 7)  call math.sqrt(b, i)
          call math.rot2(c, c, i)  call math.div(a, b, i)
        end""",
    "statistics": """
        var i  var t[20] = [5, 3, 9, -4, 0, 77, 6, 1, 2, 8, 13, -9, 4, 7, 11, 10, 12, 15, 14, 20]  var u[20]
        var low  var high  var mean
        onevent prox
        for i in 0:99 do
          call math.copy(u, t)  call math.sort(u)  call math.stat(u, low, high, mean)  call math.argbounds(t, low, high)
          call math.clamp(u, u, t, t)
        end""",
    "deques": """
        var i  var q[12]  var a  var b[2]
        onevent prox
        for i in 0:199 do
          call deque.push_back(q, i)  call deque.push_front(q, b)  call deque.get(q, a, 1)  call deque.size(q, a)
          call deque.pop_back(q, b)  call deque.pop_front(q, a)
        end""",
    "behaviour": BEHAVIOUR,
}

#: Where Debian's package ``aseba`` is unpacked, if not installed.
ROOT = os.environ.get("ASEBA_ROOT", "")

PROX = 0xFFFE - [event.name for event in THYMIO_II.local_events].index("prox")


LEAST_TIMES_C = {"arithmetic": 10.0, "array": 10.0, "branchy": 10.0, "subroutines": 10.0, "behaviour": 1.2}
"""Least speed of WebAssembly in units of the C machine's."""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--rounds", type=int, default=5, help="rounds; the figures are their medians")
    parser.add_argument("--seconds", type=float, default=0.1, help="of processor time for each figure of a round")
    parser.add_argument("--words", type=int, nargs="+", default=[100, 300, 1000, 1500], help="of programs to translate")


def measure(options: argparse.Namespace) -> Report:
    """Measure all programs on all engines."""
    engines = [INTERPRETER, *([WASM] if is_usable() else [])]
    found = {name: _measure(source, engines, options) for name, source in PROGRAMS.items()}
    columns = ["M instructions/s", "per event", *engines, "C", *(f"{name} × C" for name in engines[1:])]
    rows = [
        [
            name,
            row["instructions"],
            *(row.get(engine) for engine in (*engines, "C")),
            *(row[engine] / row["C"] if "C" in row else None for engine in engines[1:]),
        ]
        for name, row in found.items()
    ]
    times = [[name, *map(_translation_time, options.words)] for name in engines[1:]]
    translation = Table(["translation and first event, ms; words:", *map(str, options.words)], times)
    goals = [
        Goal(f"{name}, {WASM}, to the C machine", limit, found[name][WASM] / found[name]["C"], "×", is_least=True)
        for name, limit in LEAST_TIMES_C.items()
        if "C" in found[name] and WASM in found[name]
    ]
    return Report([Table(columns, rows), translation], goals)


def _measure(source: str, engines: list[str], options: argparse.Namespace) -> dict[str, float]:
    """Return millions of instructions per second by engine."""
    program = compile(source, THYMIO_II)
    runners: dict[str, Callable[[], int]] = {name: _runner(program.words, name) for name in engines}
    per_event = runners[INTERPRETER]()
    speeds: dict[str, list[float]] = {name: [] for name in runners}
    if not _same_variables(program.words):
        raise RuntimeError("the machines disagree")
    for _ in range(options.rounds):
        for name, runner in runners.items():
            speeds[name].append(_speed(runner, per_event, options.seconds))
        native = _c_runner(program.words, per_event, 1000)
        if native is not None:
            speeds.setdefault("C", []).append(_speed(native, 1000 * per_event, options.seconds))
    return {"instructions": per_event, **{name: statistics.median(values) for name, values in speeds.items()}}


def _speed(runner: Callable[[], int], per_event: int, seconds: float) -> float:
    """Run events for so long at least."""
    repeat = 1
    while True:
        begun = time.process_time()
        for _ in range(repeat):
            runner()
        spent = time.process_time() - begun
        if spent > seconds:
            return per_event * repeat / spent / 1e6
        repeat *= 2


def _runner(words: tuple[int, ...], engine: str) -> Callable[[], int]:
    machine = VirtualMachine(THYMIO_II, engine=engine)
    machine.set_bytecode(words)
    machine.resume()
    machine.run()
    machine.pop_messages()

    def run() -> int:
        before = machine.instructions
        machine.setup(PROX)
        machine.run(65535)
        return machine.instructions - before

    for _ in range(3):
        run()
    return run


def _translation_time(size: int) -> float:
    """Return the milliseconds from bytecode of about ``size`` words to the end of its first event."""
    block = "a = (a * 3 + t[b & 3]) % 1013\nif a > b then b = b + 1 else t[1] = a end\nwhile c < 3 do c++ end\n"
    count = 1
    while len(compile(_LONG + block * count, THYMIO_II).words) < size:
        count += 1
    times = []
    for number in range(7):
        # another constant each time, as machines share translations
        program = compile(f"{_LONG}a = {number}\n{block * count}", THYMIO_II)
        machine = VirtualMachine(THYMIO_II, engine=WASM)
        machine.set_bytecode(program.words)
        machine.resume()
        begun = time.process_time()
        machine.setup(PROX)
        machine.run(65535)
        times.append(time.process_time() - begun)
    return round(1000 * statistics.median(times), 2)


_LONG = "var a\nvar b\nvar c\nvar t[4]\nonevent prox\n"
"""The head of a long program."""

_C_SIDE = r"""
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <aseba/vm/vm.h>
#include <aseba/vm/natives.h>
static uint16_t code[2048], breaks;
static int16_t words[2048], stack[64];
static AsebaVMState vm;
static AsebaNativeFunctionPointer natives[] = { NATIVES };
void AsebaSendMessage(AsebaVMState *v, uint16_t id, const void *data, uint16_t size) { breaks += size; }
void AsebaSendVariables(AsebaVMState *v, uint16_t start, uint16_t length) {}
void AsebaSendDescription(AsebaVMState *v) {}
void AsebaNativeFunction(AsebaVMState *v, uint16_t id) { natives[id](v); }
void AsebaWriteBytecode(AsebaVMState *v) {}
void AsebaResetIntoBootloader(AsebaVMState *v) {}
void AsebaPutVmToSleep(AsebaVMState *v) {}
void AsebaAssert(AsebaVMState *v, AsebaAssertReason reason) { abort(); }
void prepare(const uint16_t *program, int length) {
    memset(&vm, 0, sizeof vm); memset(code, 0, sizeof code); memset(words, 0, sizeof words);
    memcpy(code, program, 2 * length);
    vm.nodeId = 1; vm.bytecodeSize = 1534; vm.bytecode = code; vm.variablesSize = 640; vm.variables = words;
    vm.stackSize = 32; vm.stack = stack;
    AsebaVMInit(&vm);
    memcpy(code, program, 2 * length);
    vm.flags = 0;
    AsebaVMSetupEvent(&vm, 0xFFFF); AsebaVMRun(&vm, 0);
}
void event(int number, int times) {
    for (int i = 0; i < times; ++i) { AsebaVMSetupEvent(&vm, number); AsebaVMRun(&vm, 65535); }
}
int16_t *variables(void) { return words; }
"""
#: Names of the reference's functions that are not "vec" or "deq" and the rest of ours.
_C_NATIVES = {
    "math.rand": "rand",
    **{f"math.{name}": f"math{name}" for name in ("muldiv", "atan2", "sin", "cos", "rot2", "sqrt")},
}


def _c_name(native: str) -> str:
    family, _, name = native.partition(".")
    if family == "deque":
        return f"deq{name.replace('_', '')}"
    if family == "math":
        return _C_NATIVES.get(native, f"vec{name}")
    return "veccopy"


@cache
def _c_library() -> ctypes.CDLL | None:
    """Return the reference's machine behind a small interface; None without package or compiler."""
    if not Path("/usr/include/aseba/vm/vm.h").is_file() and not ROOT:
        return None
    compiler = shutil.which("cc")
    if compiler is None:
        return None
    names = [f"AsebaNative_{_c_name(native.name)}" for native in THYMIO_II.natives]
    folder = Path(tempfile.mkdtemp())
    (folder / "machine.c").write_text(_C_SIDE.replace("NATIVES", ", ".join(names)))
    library = folder / "machine.so"
    flags = ["-O2", "-shared", "-fPIC", "-DASEBA_ASSERT", f"-I{ROOT}/usr/include", f"-I{ROOT}/usr/include/aseba", "-w"]
    command = [compiler, *flags, str(folder / "machine.c"), f"{ROOT}/usr/lib/libasebavm.a", "-o", str(library)]
    if subprocess.run(command, check=False).returncode != 0:
        return None
    loaded = ctypes.CDLL(str(library))
    loaded.variables.restype = ctypes.POINTER(ctypes.c_int16)
    return loaded


def _c_runner(words: tuple[int, ...], per_event: int, times: int) -> Callable[[], int] | None:
    """Return a runner of ``times`` events on the reference's machine; None without it."""
    library = _c_library()
    if library is None:
        return None
    program = (ctypes.c_uint16 * len(words))(*words)

    def run() -> int:
        library.event(PROX, times)
        return per_event * times

    library.prepare(program, len(words))
    return run


def _same_variables(words: tuple[int, ...]) -> bool:
    """Tell whether three events end with the same variables here and there."""
    library = _c_library()
    if library is None:
        return True
    machine = VirtualMachine(THYMIO_II)
    machine.set_bytecode(words)
    machine.resume()
    machine.run()
    for _ in range(3):
        machine.setup(PROX)
        machine.run(65535)
    library.prepare((ctypes.c_uint16 * len(words))(*words), len(words))
    library.event(PROX, 3)
    return list(library.variables()[0 : len(machine.variables)]) == machine.variables
