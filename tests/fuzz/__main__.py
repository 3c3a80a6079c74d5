"""Campaigns: `python -m tests.fuzz [--target NAME]... [--inputs N] [--seconds S] [--seed S]`.

Each target runs in a process of its own with the fuzzer atheris (`pip install 'thymio_sim_ros[fuzz]'`), guided by
coverage from the kept corpus. The report is a table in Markdown; forbidden results are in `build/fuzz/<target>`.
`--keep` adds the inputs with new coverage to tests/data/fuzz, as few as have the same coverage.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from tests.fuzz import corpus
from tests.fuzz.table import MODULE_OF, TARGETS
from tests.fuzz.target import HOSTILE

BUILD = Path("build") / "fuzz"
MAX_KEPT = 60
"""Inputs of a target that are kept at most, the shortest."""
MEMORY_MB = 2048
TIMEOUT_S = 30
"""Time after which the fuzzer gives up an input that hangs."""
_PROGRESS = re.compile(r"^#(\d+)\s+(\w+)\s+(?:cov: (\d+) )?", re.MULTILINE)


@dataclass(frozen=True)
class Result:
    """The figures of one campaign."""

    inputs: int
    cov_before: int
    cov: int
    kept: int
    findings: int
    code: int

    def row(self, name: str) -> str:
        """A row of the table."""
        end = "" if self.code == 0 else f" (exit code {self.code})"
        return f"| `{name}` | {self.inputs} | {self.cov_before} | {self.cov} | {self.kept} | {self.findings}{end} |"


def main() -> int:
    """Run the campaigns one after the other; return 1 if there are findings."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__.partition("\n")[0])
    parser.add_argument("--target", action="append", choices=sorted(TARGETS), metavar="NAME", help="default: all")
    parser.add_argument("--inputs", type=int, default=20_000, help="inputs for each target (20000)")
    parser.add_argument("--seconds", type=int, default=600, help="longest time for each target (600)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", action="store_true", help="add new inputs to tests/data/fuzz")
    options = parser.parse_args()
    print("| target | inputs | coverage of the corpus | coverage at the end | corpus | findings |")
    print("|---|---|---|---|---|---|", flush=True)
    results = []
    for name in options.target or TARGETS:
        results.append(_campaign(name, options))
        print(results[-1].row(name), flush=True)
    print(f"\n{sum(one.inputs for one in results)} inputs, {sum(one.findings for one in results)} findings")
    return 1 if any(one.findings or one.code for one in results) else 0


def _campaign(name: str, options: argparse.Namespace) -> Result:
    with tempfile.TemporaryDirectory(prefix="thymio-fuzz-") as folder:
        found, start, words = Path(folder, "found"), Path(folder, "start"), Path(folder, "words")
        report = BUILD / name
        for path in (found, start):
            path.mkdir()
        report.mkdir(parents=True, exist_ok=True)
        for old in report.iterdir():
            old.unlink()
        for number, data in enumerate([*HOSTILE, *TARGETS[name].seeds(), *corpus.load(name)]):
            (start / str(number)).write_bytes(data)
        words.write_text("".join(f'"{_escaped(word)}"\n' for word in TARGETS[name].words), encoding="ascii")
        limits = [f"-timeout={TIMEOUT_S}", f"-rss_limit_mb={MEMORY_MB}", f"-artifact_prefix={report}/"]
        limits += [f"-dict={words}"] if TARGETS[name].words else []
        log = _fuzz(
            name, report, f"-runs={options.inputs}", f"-seed={options.seed}", f"-max_total_time={options.seconds}",
            *limits, str(found), str(start),
        )  # fmt: skip
        if options.keep:
            known = set(TARGETS[name].seeds())
            inputs = [path.read_bytes() for path in (*start.iterdir(), *found.iterdir())]
            _keep(name, report, [data for data in inputs if data not in known])
        return _result(name, report, log)


def _result(name: str, report: Path, log: subprocess.CompletedProcess[str]) -> Result:
    (report / "log").write_text(log.stdout, encoding="utf-8")
    rows = _PROGRESS.findall(log.stdout)
    started = next((row for row in rows if row[1] == "INITED"), ("0", "", "0"))
    last = rows[-1] if rows else started
    findings = len([*report.glob("*.txt"), *report.glob("timeout-*"), *report.glob("oom-*"), *report.glob("crash-*")])
    kept = len(corpus.load(name))
    return Result(int(last[0]), int(started[2] or 0), int(last[2] or 0), kept, findings, log.returncode)


def _keep(name: str, report: Path, inputs: Sequence[bytes]) -> None:
    """Replace the corpus by few inputs with the same coverage, and add the inputs of all findings."""
    kept = corpus.smallest(TARGETS[name], inputs, MAX_KEPT)
    corpus.store(name, [*kept, *(path.read_bytes() for path in report.glob("*.input"))])


def _fuzz(name: str, report: Path, *options: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "tests.fuzz.fuzzer", MODULE_OF[name], name, str(report), *options]
    return subprocess.run(
        command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", check=False,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, (os.getcwd(), os.environ.get("PYTHONPATH"))))},
    )  # fmt: skip


def _escaped(word: str) -> str:
    data = word.encode("utf-8", "surrogateescape")
    return "".join(chr(byte) if 32 <= byte < 127 and byte not in b'"\\' else f"\\x{byte:02x}" for byte in data)


if __name__ == "__main__":
    sys.exit(main())
