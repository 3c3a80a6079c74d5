"""Output of programs: files, the standard output, and the end of a process on Ctrl-C."""

from __future__ import annotations

import io
import os
import secrets
import signal
import stat
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

STANDARD_OUTPUT = "standard output"


def write_file(name: str, data: bytes, *, mode: int = 0o666) -> None:
    """Write a file as a whole; see `replacing`. Raises OSError."""
    with replacing(name, mode=mode) as file:
        file.write(data)


@contextmanager
def replacing(name: str, *, mode: int = 0o666) -> Iterator[BinaryIO]:
    """A file that becomes `name` at the end of the block, at once and with its content on the disk.

    On failure the file of this name keeps its content, or still does not exist. A device or a pipe is written directly.
    `mode` is that of a new file, less the umask. Raises OSError with the name.
    """
    path = Path(name).resolve()  # the target of a link
    new = path.with_name(f".{path.name[:100]}.{secrets.token_hex(4)}")
    with named_errors(name, str(path), str(new)):
        if path.exists() and not path.is_file():
            with path.open("wb") as device:
                yield device
            return
        old_mode = _mode_of_writable(path)
        try:
            with open(new, "xb", opener=lambda file, flags: os.open(file, flags, mode)) as file:
                yield file
                file.flush()
                os.fsync(file.fileno())
            if old_mode is not None:
                os.chmod(new, old_mode)
            os.replace(new, path)
        except BaseException:
            with suppress(OSError):
                os.unlink(new)
            raise


def _mode_of_writable(path: Path) -> int | None:
    """The permissions of a file, None if it does not exist. Raises OSError for one that must not be changed."""
    try:
        with path.open("r+b") as file:
            return stat.S_IMODE(os.fstat(file.fileno()).st_mode)
    except FileNotFoundError:
        return None


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
def named_errors(name: str, *others: str) -> Iterator[None]:
    """Give OSErrors raised in the block the name of a file if they have none, or one of `others`. Raises OSError."""
    try:
        yield
    except OSError as error:
        if error.filename is not None and str(error.filename) not in (name, *others):
            raise
        raise OSError(error.errno, error.strerror, name) from error
