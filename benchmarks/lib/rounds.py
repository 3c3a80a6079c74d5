"""Measures in turn: rounds, medians, and workers that measure this checkout beside another one."""

from __future__ import annotations

import argparse
import contextlib
import importlib
import json
import os
import statistics
import subprocess
import sys
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, TypeVar

from benchmarks.lib.report import ROOT

K = TypeVar("K")
NOW, BEFORE = "now", "before"
"""Names of this checkout and of that of `--against`."""


def in_turn(runs: Mapping[K, Callable[[], float]], rounds: int, warm_up: int = 1) -> dict[K, list[float]]:
    """Call all runs in each round, one after the other; return the results without those of the warm-up rounds."""
    found: dict[K, list[float]] = {name: [] for name in runs}
    for number in range(warm_up + rounds):
        for name, run in runs.items():
            value = run()
            if number >= warm_up:
                found[name].append(value)
    return found


def medians(found: Mapping[K, Iterable[float]]) -> dict[K, float]:
    """Return the median of each."""
    return {name: statistics.median(values) for name, values in found.items()}


def add_against(parser: argparse.ArgumentParser) -> None:
    """Add the option `--against`."""
    about = "another checkout of this repository: measured in turn with this one"
    parser.add_argument("--against", type=Path, metavar="PATH", help=about)


def sides(options: argparse.Namespace) -> dict[str, Path]:
    """Return the checkouts to measure: this one, and that of `--against`."""
    return {NOW: ROOT} | ({BEFORE: options.against.resolve()} if options.against else {})


class Worker:
    """A measure in a process of its own, with the packages of a checkout.

    `maker` is a function of a module of this folder, as "simulator:ours". The process calls it with `arguments`, and
    then, for each call of the worker, what it returned. Arguments and results go through JSON. The module must import
    only what both checkouts have.
    """

    def __init__(self, checkout: Path, maker: str, *arguments: Any) -> None:
        code = "import sys; sys.path.insert(0, sys.argv[1]); from benchmarks.lib import rounds; rounds.serve()"
        command = [sys.executable, "-P", "-c", code, str(ROOT), str(checkout), maker, json.dumps(arguments)]
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1)

    def __call__(self, *arguments: Any) -> Any:
        """Call what the maker returned; RuntimeError if the process has ended."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        with contextlib.suppress(BrokenPipeError):
            self._process.stdin.write(json.dumps(arguments) + "\n")
        answer = self._process.stdout.readline()
        if not answer:
            raise RuntimeError(f"a worker failed (its error is above): {' '.join(map(str, self._process.args))}")
        return json.loads(answer)

    def close(self) -> None:
        """End the process."""
        self._process.communicate()


def started(stack: contextlib.ExitStack, checkout: Path, maker: str, *arguments: Any) -> Worker:
    """Start a worker that ends with the stack."""
    worker = Worker(checkout, maker, *arguments)
    stack.callback(worker.close)
    return worker


def serve() -> None:
    """The process of a worker: this folder's modules, the packages of the checkout."""
    own, checkout, maker, arguments = sys.argv[1:]
    sys.path[sys.path.index(own)] = checkout
    os.chdir(checkout)
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)  # whatever prints must not print between the answers
    module, _, name = maker.partition(":")
    run = getattr(importlib.import_module(f"benchmarks.{module}"), name)(*json.loads(arguments))
    for line in sys.stdin:
        answers.write(json.dumps(run(*json.loads(line))) + "\n")
