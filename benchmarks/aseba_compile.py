"""Time of the compiler, all passes, for a program of 300 lines that nearly fills a Thymio.

Processor time; median, best and worst of the rounds. `--against PATH` measures another checkout in turn.
"""

from __future__ import annotations

import argparse
import contextlib
import statistics
import time
from collections.abc import Callable

from aseba_vm import compile
from aseba_vm.targets import THYMIO_II
from benchmarks.lib import rounds
from benchmarks.lib.report import Report, Table

QUICK = {"rounds": 1}

_BODY = """\
onevent ping
    when prox.horizontal[{n}] > 1000 do
        state = {n}
        speed = speed + delta * 2 - {n}
    end
    for i in 0:4 do
        values[i] = prox.horizontal[i] / 10 + offset
        if values[i] > 100 and state != {n} then
            call math.min(low, low, values[i])
            motor.left.target = speed - values[i]
            motor.right.target = speed + values[i]
        elseif values[i] < 0 then
            callsub halt
        else
            emit pong [state, values[i]]
        end
    end
"""


def program(lines: int = 300) -> str:
    """Return a program of about so many lines, as pupils write them."""
    head = "var state = 0\nvar speed = 100\nvar delta = 3\nvar offset = -2\nvar low = 0\nvar i\nvar values[5]\n\n"
    halt = "sub halt\n    motor.left.target = 0\n    motor.right.target = 0\n\n"
    blocks = (lines - head.count("\n") - halt.count("\n")) // (_BODY.count("\n") + 1)
    parts = [_BODY.replace("ping", f"ping{n}").replace("{n}", str(n % 7)) for n in range(blocks)]
    return head + halt + "\n".join(parts)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--rounds", type=int, default=15, help="rounds; the figures are their medians")
    rounds.add_against(parser)


def compiler() -> Callable[[], float]:
    """Return what compiles the program and returns the milliseconds (for a worker)."""
    source = program()
    events = [("pong", 2), *((f"ping{n}", 0) for n in range(40))]

    def run() -> float:
        begun = time.process_time()
        compile(source, THYMIO_II, events)
        return 1000 * (time.process_time() - begun)

    return run


def measure(options: argparse.Namespace) -> Report:
    """Measure the checkouts in turn."""
    with contextlib.ExitStack() as stack:
        runs = {
            side: rounds.started(stack, checkout, "aseba_compile:compiler")
            for side, checkout in rounds.sides(options).items()
        }
        times = rounds.in_turn(runs, options.rounds)
    rows = [[side, statistics.median(found), min(found), max(found)] for side, found in times.items()]
    return Report([Table(["ms", "median", "best", "worst"], rows)])
