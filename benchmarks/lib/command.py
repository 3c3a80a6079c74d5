"""The command line of all benchmarks: `python -m benchmarks [NAME] [options]`.

A benchmark is a module of this package with

- a docstring: what it measures, against what, what it needs,
- `measure(options) -> Report`,
- `QUICK`, the values of its options that `--quick` sets, and
- `add_options(parser)`, if it has options of its own.

Its exit code is 0, or `MISSING` when something that it cannot run without is missing, as the last line says.
"""

from __future__ import annotations

import argparse
import ast
import contextlib
import importlib
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from types import ModuleType

from benchmarks.lib import page, report

MISSING = 77
"""Exit code, as in automake, of a benchmark that cannot run on this machine."""
OWN = {"aseba_vm", "benchmarks", "tests", "thymio_sim_ros"}
"""Packages of the repository, which are never missing: a module that they lack is a defect."""

FOLDER = Path(__file__).resolve().parent.parent


class MissingError(Exception):
    """Something that a benchmark needs is missing: `kind` is "module", "program" or "file"."""

    def __init__(self, kind: str, name: str) -> None:
        super().__init__(f"missing {kind}: {name}")


def names() -> list[str]:
    """Return all benchmarks: every module of the folder."""
    return sorted(path.stem for path in FOLDER.glob("*.py") if not path.stem.startswith("_"))


def main(arguments: Sequence[str]) -> int:
    """Run one benchmark, or all; return the exit code."""
    if arguments and not arguments[0].startswith("-"):
        return run(arguments[0], arguments[1:])
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks",
        description=f"Run all benchmarks, store their results, and write all tables of {page.PAGE.name}.",
        epilog="Benchmarks (python -m benchmarks NAME --help):\n"
        + "".join(f"  {_summary(name)}\n" for name in names()),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--render", action="store_true", help="only write the tables again, from the stored results")
    parser.add_argument("--quick", action="store_true", help="run all code in small sizes; results are not stored")
    parser.add_argument("--only", nargs="+", choices=names(), metavar="NAME", help="run only these")
    parser.add_argument(
        "--against", type=Path, metavar="PATH", help="another checkout, for the benchmarks that compare"
    )
    options = parser.parse_args(arguments)
    code = 0 if options.render else run_all(options)
    if not options.quick:
        page.render()
    return code


def run_all(options: argparse.Namespace) -> int:
    """Run the benchmarks, each in a process of its own; return 1 if one failed. A missing peer is no failure."""
    failed = []
    for name in options.only or names():
        print(f"== {name}", flush=True)
        command = [sys.executable, "-m", "benchmarks", name]
        if options.quick:
            command += ["--quick"]
        if options.against and _can_compare(name):
            command += ["--against", str(options.against)]
        with tempfile.TemporaryDirectory() as folder:
            found = Path(folder) / f"{name}.json"
            code = subprocess.run([*command, "--json", str(found)], cwd=report.ROOT, check=False).returncode
            if code == 0 and not options.quick:
                report.save(page.RESULTS / found.name, report.load(found))
        if code not in (0, MISSING):
            failed.append(name)
    if failed:
        print("failed:", *failed, file=sys.stderr)
    return 1 if failed else 0


def run(name: str, arguments: Sequence[str]) -> int:
    """Run one benchmark with its own options."""
    if name not in names():
        print(f"there is no benchmark {name!r}; there are {', '.join(names())}", file=sys.stderr)
        return 2
    try:
        return _run(importlib.import_module(f"benchmarks.{name}"), name, arguments)
    except ModuleNotFoundError as error:
        missing = MissingError("module", _not_own(error))
    except MissingError as error:
        missing = error
    if {"-h", "--help"} & set(arguments):
        print(_docstring(name))
    print(missing, file=sys.stderr)
    return MISSING


class _Formatter(argparse.ArgumentDefaultsHelpFormatter, argparse.RawDescriptionHelpFormatter):
    """Keeps the lines of the description and shows the defaults of options that have one."""

    def _get_help_string(self, action: argparse.Action) -> str | None:
        return super()._get_help_string(action) if action.default else action.help


def _run(module: ModuleType, name: str, arguments: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(
        prog=f"python -m benchmarks {name}",
        description=module.__doc__,
        formatter_class=_Formatter,
    )
    quick = ", ".join(f"{key}={value}" for key, value in module.QUICK.items())
    parser.add_argument("--quick", action="store_true", help=f"all code in small sizes, within seconds ({quick})")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the result there")
    if hasattr(module, "add_options"):
        module.add_options(parser)
    if "--quick" in arguments:
        parser.set_defaults(**module.QUICK)
    options = parser.parse_args(arguments)
    load = os.getloadavg()[0]
    with _domain():
        measured = module.measure(options)
    kept = [argument for argument in arguments if argument not in ("--json", str(options.json))]
    against = getattr(options, "against", None)
    if against is not None:
        kept = [argument if argument != str(against) else report.commit(against) for argument in kept]
    stored = report.result(name, measured, kept, against, load)
    print(report.markdown(stored))
    if measured.goals:
        print(f"\n{report.goals_table([stored])}")
    if options.json is not None:
        report.save(options.json, stored)
    return 0


@contextlib.contextmanager
def _domain() -> Iterator[None]:
    """Reserve a domain for everything of ROS, where ROS is installed."""
    try:
        from thymio_sim_ros.testing.ros.domain import reserved
    except ModuleNotFoundError as error:
        _not_own(error)
        yield
        return
    with reserved():
        yield


def _not_own(error: ModuleNotFoundError) -> str:
    """Return the missing package; raise the error if it is one of the repository."""
    package = (error.name or "").partition(".")[0]
    if package in OWN:
        raise error
    return package


def _docstring(name: str) -> str:
    return ast.get_docstring(ast.parse(_source(name))) or ""


def _can_compare(name: str) -> bool:
    """Whether a benchmark has the option `--against`; without an import, which may need what is missing."""
    return "rounds.add_against(parser)" in _source(name)


def _source(name: str) -> str:
    return (FOLDER / f"{name}.py").read_text(encoding="utf-8")


def _summary(name: str) -> str:
    return f"{name:20} {_docstring(name).partition(chr(10))[0]}"
