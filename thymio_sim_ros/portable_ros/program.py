"""Runs a program on the embedded graph, as `python FILE` or `python -m MODULE` runs it."""

from __future__ import annotations

import runpy
import sys
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType

__all__ = ["run_program"]

_FAILED = 1
_OF_INTERFACES = ("_msgs", "_srvs", "_interfaces")
"""Ends of the names of packages with types."""
_NOT_ITS_OWN = (__file__, "<frozen runpy>", runpy.__file__)


def run_program(target: str, arguments: Sequence[str], *, is_module: bool) -> int:
    """Run a file, or a module, as the main program; return the exit code. Python waits for its threads when it ends.

    An exception is printed as Python prints it, from the program on. The import hook has to be installed. Raises what
    ends programs: SystemExit and KeyboardInterrupt.
    """
    sys.argv = [target, *arguments]
    try:
        if is_module:
            sys.path[0] = str(Path.cwd())
            runpy.run_module(target, run_name="__main__", alter_sys=True)
        else:
            sys.path[0] = str(Path(target).resolve().parent)
            runpy.run_path(target, run_name="__main__")
    except Exception as error:
        if isinstance(error, ModuleNotFoundError) and (error.name or "").endswith(_OF_INTERFACES):
            error.add_note(
                f"The embedded graph has no types of {error.name}: copy the folder of that package, with its msg, srv"
                " or action files, beside your package, into src of your workspace."
            )
        trace = _from_program(error.__traceback__)
        sys.excepthook(type(error), error.with_traceback(trace), trace)
        return _FAILED
    return 0


def _from_program(trace: TracebackType | None) -> TracebackType | None:
    """The part of a traceback that begins in the program."""
    while trace is not None and trace.tb_frame.f_code.co_filename in _NOT_ITS_OWN:
        trace = trace.tb_next
    return trace
