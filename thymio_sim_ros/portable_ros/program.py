"""Runs a program on the embedded graph, as `python FILE` or `python -m MODULE` runs it."""

from __future__ import annotations

import runpy
import sys
import threading
from collections.abc import Sequence
from pathlib import Path

__all__ = ["join_threads", "run_program"]


def run_program(target: str, arguments: Sequence[str], *, is_module: bool) -> None:
    """Run a file, or a module, as the main program, with its arguments. The import hook has to be installed."""
    sys.argv = [target, *arguments]
    if is_module:
        sys.path[0] = str(Path.cwd())
        runpy.run_module(target, run_name="__main__", alter_sys=True)
    else:
        sys.path[0] = str(Path(target).resolve().parent)
        runpy.run_path(target, run_name="__main__")


def join_threads() -> None:
    """Wait for the threads of the program, as the end of the interpreter does."""
    for thread in threading.enumerate():
        if thread is not threading.current_thread() and not thread.daemon:
            thread.join()
