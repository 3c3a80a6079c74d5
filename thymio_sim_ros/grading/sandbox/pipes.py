"""Pipes between supervisor and test process: Windows passes handles instead of files, and cannot select them."""

from __future__ import annotations

import os
import selectors
import sys
import time
from collections.abc import Sequence
from typing import Any

__all__ = ["PipeReader", "inherited", "opened", "word"]

_CHUNK = 65536

if sys.platform == "win32":
    import _winapi
    import msvcrt
    import subprocess

    _PAUSE_S = 0.005
    """Time between two looks at pipes, which Windows cannot wait for."""

    def word(file: int) -> str:
        """The word by which a child process finds an inherited file."""
        return str(msvcrt.get_osfhandle(file))

    def inherited(files: Sequence[int]) -> dict[str, Any]:
        """Options of Popen for a child that inherits these files."""
        handles = [msvcrt.get_osfhandle(file) for file in files]
        for handle in handles:
            os.set_handle_inheritable(handle, True)
        return {"startupinfo": subprocess.STARTUPINFO(lpAttributeList={"handle_list": handles})}

    def opened(handed: str) -> int:
        """The inherited file of a word, in the child process, which its own children do not inherit."""
        os.set_handle_inheritable(int(handed), False)
        return msvcrt.open_osfhandle(int(handed), os.O_BINARY)

    class PipeReader:
        """Reads from pipes what is there."""

        def __init__(self, *files: int) -> None:
            self._open = set(files)

        def wait(self, timeout_s: float) -> None:
            """Wait until a pipe has something."""
            end_s = time.monotonic() + timeout_s
            while not any(self._size(file) for file in tuple(self._open)) and time.monotonic() < end_s:
                time.sleep(_PAUSE_S)

        def read(self, file: int) -> bytes:
            """Return a part of what a pipe has; empty if there is nothing."""
            size = self._size(file)
            return os.read(file, min(size, _CHUNK)) if size else b""

        def has_ended(self, file: int) -> bool:
            """Whether `read` has found the end of a pipe."""
            return file not in self._open

        def close(self) -> None:
            """Release what waits for the pipes."""

        def _size(self, file: int) -> int:
            if file not in self._open:
                return 0
            try:
                return _winapi.PeekNamedPipe(msvcrt.get_osfhandle(file), 0)[0]
            except BrokenPipeError:  # closed by the process, which may still run
                self._open.discard(file)
                return 0

else:

    def word(file: int) -> str:
        """The word by which a child process finds an inherited file."""
        return str(file)

    def inherited(files: Sequence[int]) -> dict[str, Any]:
        """Options of Popen for a child that inherits these files."""
        return {"pass_fds": tuple(files)}

    def opened(handed: str) -> int:
        """The inherited file of a word, in the child process, which its own children do not inherit."""
        os.set_inheritable(int(handed), False)
        return int(handed)

    class PipeReader:
        """Reads from pipes what is there."""

        def __init__(self, *files: int) -> None:
            self._selector = selectors.DefaultSelector()
            for file in files:
                os.set_blocking(file, False)
                self._selector.register(file, selectors.EVENT_READ)

        def wait(self, timeout_s: float) -> None:
            """Wait until a pipe has something."""
            self._selector.select(timeout_s) if self._selector.get_map() else time.sleep(timeout_s)

        def read(self, file: int) -> bytes:
            """Return a part of what a pipe has; empty if there is nothing."""
            try:
                chunk = os.read(file, _CHUNK)
            except BlockingIOError:
                return b""
            if not chunk and file in self._selector.get_map():
                self._selector.unregister(file)  # closed by the process, which may still run
            return chunk

        def has_ended(self, file: int) -> bool:
            """Whether `read` has found the end of a pipe."""
            return file not in self._selector.get_map()

        def close(self) -> None:
            """Release what waits for the pipes."""
            self._selector.close()
