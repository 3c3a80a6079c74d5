"""Keyboard: the standard input of a program, whose lines arrive at simulated times."""

from __future__ import annotations

import io
import sys
from collections import deque
from typing import Any

from thymio_sim_ros.lockstep.turns import Turns

__all__ = ["Keyboard", "install"]


class Keyboard(io.TextIOBase):
    """Standard input from a test. A line can be read when simulated time has reached its time."""

    def __init__(self, turns: Turns) -> None:
        self._turns = turns
        self._lines: deque[tuple[int, str]] = deque()
        self._rest = ""
        self.is_closed_after = False
        """Whether nothing is typed after these lines: reading then ends, as after Ctrl-D."""

    def type(self, at_ns: int, line: str) -> None:
        """Add a line for a simulated time."""
        self._lines.append((at_ns, line))

    def has_line(self) -> bool:
        """Whether reading does not wait."""
        if self._rest:
            return True
        if self._lines:
            return self._lines[0][0] <= self._turns.now_ns
        return self.is_closed_after

    def readline(self, size: int | None = -1, /) -> str:  # type: ignore[override]
        """Wait for a line; "" at the end of all lines."""
        self._fill()
        end = len(self._rest) if size is None or size < 0 else size
        end = min(end, self._rest.find("\n") + 1 or len(self._rest))
        line, self._rest = self._rest[:end], self._rest[end:]
        return line

    def read(self, size: int | None = -1, /) -> str:
        """Wait for this many characters; all of them until the end if `size` is negative."""
        wanted = None if size is None or size < 0 else size
        text = ""
        while wanted is None or len(text) < wanted:
            more = self.readline(-1 if wanted is None else wanted - len(text))
            if not more:
                break
            text += more
        return text

    def readable(self) -> bool:
        """True."""
        return True

    def fileno(self) -> int:
        """The descriptor of the empty file behind the keyboard."""
        return 0

    def _fill(self) -> None:
        while not self._rest:
            deadline_ns = self._lines[0][0] if self._lines else None
            self._turns.wait(self.has_line, deadline_ns, "input")
            if not self._lines:
                return
            if self.has_line():
                self._rest = self._lines.popleft()[1]


def install(turns: Turns) -> Keyboard:
    """Make it the standard input; settings of a terminal are ignored."""
    keyboard = Keyboard(turns)
    sys.stdin = keyboard
    try:
        import termios
        import tty
    except ImportError:
        return keyboard
    for module, name, value in (
        (termios, "tcgetattr", [0, 0, 0, 0, 0, 0, []]),
        (termios, "tcsetattr", None),
        (termios, "tcflush", None),
        (tty, "setraw", None),
        (tty, "setcbreak", None),
    ):
        setattr(module, name, _ignored_for_keyboard(getattr(module, name), value))
    return keyboard


def _ignored_for_keyboard(function: Any, value: Any) -> Any:
    def replaced(file: Any, *args: Any, **kwargs: Any) -> Any:
        if file == 0 or isinstance(file, Keyboard):
            return value
        return function(file, *args, **kwargs)

    return replaced
