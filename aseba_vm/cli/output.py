"""Output of programs: files, the standard output, and the end of a process on Ctrl-C."""

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
    """Replace the content of a file atomically. Raises OSError.

    On failure the file keeps its content, or still does not exist.
    """
    with named_errors(name):
        path = Path(name).resolve()  # the target of a link
        is_new = not path.exists()
        handle, new = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(data)
            with path.open("ab"):
                pass  # a read-only file must not be replaced
            shutil.copymode(path, new)
            os.replace(new, path)
        except BaseException:
            os.unlink(new)
            if is_new:
                path.unlink(missing_ok=True)
            raise


def print_bytes(data: bytes) -> None:
    """Write encoded text to the standard output. Raises OSError."""
    sys.stdout.flush()
    sys.stdout.buffer.write(data)


@contextmanager
def standard_output() -> Iterator[None]:
    """Escape characters that the encoding of the standard output lacks, and name it in errors. Raises OSError."""
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
    try:
        yield
        sys.stdout.flush()
    except OSError as error:
        if error.filename is not None:
            raise
        # Discard the rest of the buffer, on which the end of the process would fail again.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise OSError(error.errno, error.strerror, STANDARD_OUTPUT) from error


def open_standard_streams() -> None:
    """Open closed standard streams (`aseba … >&-`, some services) to the null device.

    Otherwise Python leaves None in their place, and the next file that is opened gets their descriptor.
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
    """End the process as the default action of a signal, so a shell loop around it also ends on SIGINT."""
    signal.signal(number, signal.SIG_DFL)
    signal.raise_signal(number)


@contextmanager
def named_errors(name: str) -> Iterator[None]:
    """Give OSErrors raised in the block the name of a file. Raises OSError."""
    try:
        yield
    except OSError as error:
        raise OSError(error.errno, error.strerror, name) from error
