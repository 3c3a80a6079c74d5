"""Lines that the landing tier covers, of those that all tests cover: `python -m tests.tier_coverage`.

Runs `make test`, then what only `make test-all` has, under coverage.py with all child processes, and prints the
table of docs/testing.md. Takes about twice as long as `make test-all`; needs the package `coverage`.
"""

from __future__ import annotations

import subprocess
import sys
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "build" / "coverage"
PARTS = {"landing": "not slow", "night": "slow"}
"""Name of the data → the tests of which it is."""
DEEPER = ("thymio_sim_ros/sim", "thymio_sim_ros/ros", "thymio_sim_ros/network")
"""Folders whose folders are packages of docs/architecture.md."""
CONFIG = """\
[run]
source_pkgs = aseba_vm, thymio_sim_ros
parallel = true
relative_files = true
concurrency = thread, multiprocessing
patch = subprocess, _exit
disable_warnings = no-data-collected, module-not-measured, module-not-imported, already-imported, couldnt-parse
"""


def measure(part: str, *arguments: str) -> int:
    """Run the tests of a part under coverage.py; returns the exit code of pytest."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    config = FOLDER / f"{part}.ini"
    config.write_text(f"{CONFIG}data_file = {FOLDER / part}\n", encoding="utf-8")
    pytest = ["-m", "pytest", "-q", "-n", "auto", "-m", PARTS[part]]
    run = [sys.executable, "-m", "coverage", "run", f"--rcfile={config}", *pytest, *arguments]
    code = subprocess.run(run, cwd=ROOT, check=False).returncode
    combine = [sys.executable, "-m", "coverage", "combine", "-q", f"--rcfile={config}", f"--data-file={FOLDER / part}"]
    subprocess.run(combine, cwd=ROOT, check=True)
    return code


def lines_of(part: str) -> set[tuple[str, int]]:
    """The covered lines of a part: path from the root, and number."""
    from coverage import CoverageData

    data = CoverageData(basename=str(FOLDER / part))
    data.read()
    covered = set()
    for name in data.measured_files():
        path = ROOT / name  # copies that tests make elsewhere do not count
        if path.is_relative_to(ROOT):
            covered |= {(path.relative_to(ROOT).as_posix(), line) for line in data.lines(name) or ()}
    return covered


def package_of(path: str) -> str:
    """The package of a module, as docs/architecture.md divides the project."""
    folder = path.rpartition("/")[0]
    depth = 3 if folder.startswith(DEEPER) else 2
    return "/".join(folder.split("/")[:depth]) + "/"


def table(landing: set[tuple[str, int]], night: set[tuple[str, int]]) -> list[str]:
    """A row for each package: covered lines of all tests, the part of them that the landing tier covers."""
    every = Counter(package_of(path) for path, _ in landing | night)
    of_landing = Counter(package_of(path) for path, _ in landing)
    rows = ["| package | lines | landing |", "|---|---|---|"]
    for package, lines in sorted(every.items()):
        rows.append(f"| `{package}` | {lines} | {100 * of_landing[package] / lines:.1f} % |")
    rows.append(f"| all | {every.total()} | {100 * of_landing.total() / every.total():.1f} % |")
    return rows


def main() -> int:
    """Measure both parts (or those that are named), and print the table and the lines that only the night covers."""
    code = max(measure(part) for part in sys.argv[1:] or PARTS)
    landing, night = lines_of("landing"), lines_of("night")
    print("\n".join(table(landing, night)))
    for path, line in sorted(night - landing):
        print(f"{path}:{line}", file=sys.stderr)
    return code


if __name__ == "__main__":
    sys.exit(main())
