"""The process that fuzzes one target with atheris: `python -m tests.fuzz.fuzzer MODULE TARGET REPORT [options]`.

An input with a forbidden result ends nothing: it is written to the folder `REPORT` with its traceback, once for each
place in the code, and the campaign continues. The options are those of libFuzzer.
"""

from __future__ import annotations

import importlib
import sys
import time
import traceback
import warnings
from pathlib import Path
from types import TracebackType

import atheris

__all__ = ["SLOW_S", "Findings"]

SLOW_S = 1.0
"""Processor time above which an input is a finding. Coverage costs about a factor of ten."""
_PACKAGES = ["aseba_vm", "thymio_sim_ros", "tomllib", "zipfile", "wave"]


class Findings:
    """The forbidden results of one target, by their place."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._seen: set[str] = set()

    def add(self, place: str, data: bytes, text: str) -> None:
        """Keep a result if it is the first at its place."""
        if place in self._seen:
            return
        self._seen.add(place)
        self._folder.mkdir(parents=True, exist_ok=True)
        path = self._folder / f"{len(self._seen):02d}"
        path.with_suffix(".input").write_bytes(data)
        path.with_suffix(".txt").write_text(f"{place}\n{data!r}\n\n{text}", encoding="utf-8", errors="replace")


def _place(error: BaseException) -> str:
    """The innermost line of this project, and the class of the exception."""
    found = ""
    at: TracebackType | None = error.__traceback__
    while at is not None:
        name = at.tb_frame.f_code.co_filename
        if any(part in name for part in ("/aseba_vm/", "/thymio_sim_ros/", "/tests/")) and "fuzzer.py" not in name:
            found = f"{name}:{at.tb_lineno}"
        at = at.tb_next
    return f"{type(error).__name__} at {found}"


def main(argv: list[str]) -> None:
    """Fuzz until libFuzzer ends the process."""
    module, name, report, *options = argv
    with atheris.instrument_imports(include=_PACKAGES):
        targets = importlib.import_module(f"tests.fuzz.targets.{module}").TARGETS
    target = {one.name: one for one in targets}[name]
    findings = Findings(Path(report))
    for seed in target.seeds():  # the first run imports what is imported on demand
        target.accepts(seed)
        break
    warnings.simplefilter("error")

    def run(data: bytes) -> None:
        began_s = time.process_time()
        try:
            target.accepts(data)
        except (KeyboardInterrupt, SystemExit):
            raise
        except BaseException as error:
            findings.add(_place(error), data, "".join(traceback.format_exception(error)))
        spent_s = time.process_time() - began_s
        if spent_s > SLOW_S:
            findings.add(f"slow: {round(spent_s)} s", data, "")

    atheris.Setup([sys.argv[0], f"-max_len={target.max_bytes}", *options], run)
    atheris.Fuzz()


if __name__ == "__main__":
    main(sys.argv[1:])
