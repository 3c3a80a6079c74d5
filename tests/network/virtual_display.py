"""Mouse and keyboard of an X display, by its test extension; for programs that have a window only."""

from __future__ import annotations

import ctypes
import ctypes.util

LEFT_BUTTON = 1
_SHIFTED = {'"': "quotedbl", "(": "parenleft", ")": "parenright", "*": "asterisk", "+": "plus", ":": "colon"}
_PLAIN = {
    " ": "space", "\n": "Return", "=": "equal", ".": "period", ",": "comma", "-": "minus", "[": "bracketleft",
    "]": "bracketright",
}  # fmt: skip


def is_available() -> bool:
    """Whether the libraries of X are installed."""
    return all(_library(name) is not None for name in ("X11", "Xtst"))


def _library(name: str) -> str | None:
    return ctypes.util.find_library(name)


class VirtualDisplay:
    """One display, such as ":99". Raises OSError if it cannot be opened."""

    def __init__(self, name: str) -> None:
        self._x11, self._xtst = ctypes.CDLL(_library("X11")), ctypes.CDLL(_library("Xtst"))
        self._x11.XOpenDisplay.restype = ctypes.c_void_p
        self._x11.XStringToKeysym.restype = ctypes.c_ulong
        self._display = ctypes.c_void_p(self._x11.XOpenDisplay(name.encode()))
        if not self._display:
            raise OSError(f"display {name} cannot be opened")

    def click(self, x: int, y: int) -> None:
        """Move the mouse and press its left button."""
        self._xtst.XTestFakeMotionEvent(self._display, -1, x, y, 0)
        for is_down in (1, 0):
            self._xtst.XTestFakeButtonEvent(self._display, LEFT_BUTTON, is_down, 0)
        self._x11.XSync(self._display, 0)

    def type(self, text: str) -> None:
        """Type a text of letters, digits and the signs of the tables above."""
        for letter in text:
            name = _PLAIN.get(letter) or _SHIFTED.get(letter) or letter
            self._key(name, is_shifted=letter in _SHIFTED or letter.isupper())
        self._x11.XSync(self._display, 0)

    def select_all(self) -> None:
        """Press Ctrl-A."""
        self._press("Control_L", "a")
        self._x11.XSync(self._display, 0)

    def close(self) -> None:
        """Close the connection to the display."""
        self._x11.XCloseDisplay(self._display)

    def _key(self, name: str, *, is_shifted: bool) -> None:
        self._press(*(["Shift_L", name] if is_shifted else [name]))

    def _press(self, *keys: str) -> None:
        codes = [self._x11.XKeysymToKeycode(self._display, self._x11.XStringToKeysym(key.encode())) for key in keys]
        for code in codes:
            self._xtst.XTestFakeKeyEvent(self._display, code, 1, 0)
        for code in reversed(codes):
            self._xtst.XTestFakeKeyEvent(self._display, code, 0, 0)
