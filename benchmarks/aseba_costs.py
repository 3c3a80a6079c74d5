"""Time of native functions beside what they are charged (`thymio_sim_ros/device/costs.py`).

The unit is an instruction on the interpreter, in a loop that counts. Each native function is called in Python with
arguments of one word and, where any size is allowed, of a hundred: the median of the rounds. The table has the
functions that take most in proportion to their charge.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

from aseba_vm import VirtualMachine, compile
from aseba_vm.jit.tiering import INTERPRETER
from aseba_vm.machine.native_call import Signature
from aseba_vm.targets import THYMIO_II
from benchmarks.lib.report import Report, Table
from thymio_sim_ros.device.costs import BYTES_PER_INSTRUCTION, COSTS
from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.layout import target
from thymio_sim_ros.device.options import DeviceOptions

QUICK = {"rounds": 1, "slow_rounds": 1}
COUNT = "var i\nvar k = 0\nwhile k == 0 do\ni = i + 1\nend"
FIRST = 200
"""Address of the first argument: behind the robot's own variables."""
MANY = 100
SOUND_BYTES = 1_000_000


def instruction_us() -> float:
    """Time of an instruction."""
    machine = VirtualMachine(THYMIO_II, engine=INTERPRETER)
    machine.load(compile(COUNT, THYMIO_II))
    machine.run(1000)
    return min(_timed(lambda: machine.run(20_000)) for _ in range(20)) / 20_000


def _timed(act: Callable[[], object]) -> float:
    begin = time.perf_counter()
    act()
    return (time.perf_counter() - begin) * 1e6


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--rounds", type=int, default=200, help="rounds; the figures are their medians")
    parser.add_argument("--top", type=int, default=20, help="rows of the table")
    parser.add_argument("--slow-rounds", type=int, default=20, help="rounds of functions that write files")


def measure(options: argparse.Namespace) -> Report:
    """Measure all native functions."""
    unit_us = instruction_us()
    rows = sorted(_rows(options, unit_us), key=lambda row: -row[-1])[: options.top]
    title = (
        f"An instruction takes {unit_us:.2f} µs; {BYTES_PER_INSTRUCTION} bytes of a sound are charged as one, "
        f"an event as {COSTS.emit.base} instructions and {COSTS.emit.per_word} for each word"
    )
    columns = ["native function", "words", "instructions", "charged", "ratio"]
    return Report([Table(columns, rows, title)])


def _rows(options: argparse.Namespace, unit_us: float) -> Iterator[tuple[str, int, float, int, float]]:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        device = AsebaDevice(options=DeviceOptions(card=folder / "card", settings=folder / "settings"))
        for letter in "pr":
            (folder / "card" / f"{letter}1.wav").write_bytes(bytes(44 + SOUND_BYTES))
        machine = device._vm
        for number, native in enumerate(target().natives):
            signature = Signature.of(native, COSTS.of(native.name))
            is_slow = "flash" in native.name or "sound." in native.name
            for size in (1, MANY) if native.free_sizes else (1,):
                addresses, end = [], FIRST
                for parameter in native.parameters:
                    addresses.append(end)
                    end += parameter.size if parameter.size > 0 else size
                popped = addresses + [size] * (signature.count - len(addresses))
                if end > len(machine.variables):
                    continue
                times = []
                for _ in range(options.slow_rounds if is_slow else options.rounds):
                    machine.variables[FIRST:end] = [1] * (end - FIRST)
                    device.services.requested = ""
                    machine.extra_cost = 0
                    times.append(_timed(partial(machine.natives.call, number, 0, popped)))
                charged = 1 + signature.call_cost(popped) + machine.extra_cost
                machine.extra_cost = 0
                device.pop_commands()
                device.load_meter.pop()
                machine.pop_messages()
                taken = statistics.median(times) / unit_us
                yield (f"`{native.name}`", size, taken, charged, taken / charged)
