"""Where programs write, and how a command line ends: files, the standard output, Ctrl-C."""

from __future__ import annotations

import io
import os
import shutil
import signal
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

STANDARD_OUTPUT = "standard output"


def write_file(name: str, data: bytes) -> None:
    """Write a file. Raises OSError."""
    with named_errors(name):
        Path(name).write_bytes(data)


def rewrite_file(name: str, data: bytes) -> None:
    """Give a file another content; where that fails, it keeps its own, or is not there as before. Raises OSError."""
    with named_errors(name):
        path = Path(name).resolve()  # what a link leads to
        is_new = not path.exists()
        handle, new = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(data)
            with path.open("ab"):
                pass  # a file that may not be written is not replaced either
            shutil.copymode(path, new)
            os.replace(new, path)
        except BaseException:
            os.unlink(new)
            if is_new:
                path.unlink(missing_ok=True)
            raise


def print_bytes(data: bytes) -> None:
    """Write to the standard output what is already encoded. Raises OSError."""
    sys.stdout.flush()
    sys.stdout.buffer.write(data)


@contextmanager
def standard_output() -> Iterator[None]:
    """Meanwhile letters that the standard output lacks become escapes, and its errors have a name. Raises OSError."""
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
    try:
        yield
        sys.stdout.flush()
    except OSError as error:
        if error.filename is not None:
            raise
        # What is left of it goes nowhere: the end of the process would fail on it once more.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise OSError(error.errno, error.strerror, STANDARD_OUTPUT) from error


def open_standard_streams() -> None:
    """Open those of stdin, stdout and stderr that were closed (`aseba … >&-`, some services): to nowhere.

    Python leaves None in their place, and the next file that is opened gets their descriptor.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            descriptor = os.open(os.devnull, os.O_RDWR)  # the lowest free number: that of the closed stream
            if descriptor != number:
                os.dup2(descriptor, number)
                os.close(descriptor)
            mode = "r" if number == 0 else "w"
            setattr(sys, name, open(number, mode, encoding="utf-8", closefd=False))  # noqa: SIM115


def exit_by_signal(number: int) -> None:
    """End the process as this signal does, without a word: on SIGINT the loop of a shell around it ends, too."""
    signal.signal(number, signal.SIG_DFL)
    signal.raise_signal(number)


@contextmanager
def named_errors(name: str) -> Iterator[None]:
    """Meanwhile errors have the name of this file. Raises OSError."""
    try:
        yield
    except OSError as error:
        raise OSError(error.errno, error.strerror, name) from error
