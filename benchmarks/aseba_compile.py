"""Time of the compiler for a program of 300 lines: median, best and worst of the rounds, as a table and as JSON.

python benchmarks/aseba_compile.py --rounds 15 --json compile.json
"""

from __future__ import annotations

import argparse
import json
import statistics
import time
from pathlib import Path

from aseba_vm import compile
from aseba_vm.targets import THYMIO_II

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
    """Return a program of about that many lines, as pupils write them."""
    head = "var state = 0\nvar speed = 100\nvar delta = 3\nvar offset = -2\nvar low = 0\nvar i\nvar values[5]\n\n"
    halt = "sub halt\n    motor.left.target = 0\n    motor.right.target = 0\n\n"
    blocks = (lines - head.count("\n") - halt.count("\n")) // (_BODY.count("\n") + 1)
    parts = [_BODY.replace("ping", f"ping{n}").replace("{n}", str(n % 7)) for n in range(blocks)]
    return head + halt + "\n".join(parts)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description="Time of the compiler for a program of 300 lines.")
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures there too")
    options = parser.parse_args()
    source = program()
    events = [("pong", 2), *((f"ping{n}", 0) for n in range(40))]
    times = []
    for _ in range(options.rounds):
        begun = time.perf_counter()
        compiled = compile(source, THYMIO_II, events)
        times.append(1000 * (time.perf_counter() - begun))
    figures = {
        "lines": source.count("\n"),
        "words": len(compiled.words),
        "rounds": options.rounds,
        "median_ms": round(statistics.median(times), 2),
        "best_ms": round(min(times), 2),
        "worst_ms": round(max(times), 2),
    }
    for name, value in figures.items():
        print(f"{name:10} {value}")
    if options.json is not None:
        options.json.write_text(json.dumps(figures) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
