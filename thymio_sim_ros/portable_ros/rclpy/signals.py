"""Signals: Ctrl-C and SIGTERM shut all contexts down."""

from __future__ import annotations

import signal
import threading
import weakref
from collections.abc import Callable
from enum import IntEnum
from types import FrameType
from typing import TYPE_CHECKING, Any

from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import require_argument

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy.context import Context

__all__ = [
    "SignalHandlerOptions",
    "get_current_signal_handlers_options",
    "install_signal_handlers",
    "uninstall_signal_handlers",
]


class SignalHandlerOptions(IntEnum):
    """Which signals shut contexts down."""

    NO = 0
    SIGINT = 1
    SIGTERM = 2
    ALL = 3


_SIGNALS = {SignalHandlerOptions.SIGINT: signal.SIGINT, SignalHandlerOptions.SIGTERM: signal.SIGTERM}
_contexts: weakref.WeakKeyDictionary[Context, Callable[[], object]] = weakref.WeakKeyDictionary()
_before: dict[int, Any] = {}


def install_signal_handlers(options: SignalHandlerOptions = SignalHandlerOptions.ALL) -> None:
    """Handle signals from now on, in addition to the handlers of the program. Only the main thread can.

    Raises TypeError for other options than those of SignalHandlerOptions.
    """
    require_argument("install_signal_handlers", options, SignalHandlerOptions)
    if threading.current_thread() is not threading.main_thread():
        return
    for option, number in _SIGNALS.items():
        if options & option and number not in _before:
            _before[number] = signal.signal(number, _handle)


def get_current_signal_handlers_options() -> SignalHandlerOptions:
    """The signals that are handled."""
    return SignalHandlerOptions(sum(option for option, number in _SIGNALS.items() if number in _before))


def uninstall_signal_handlers() -> None:
    """Restore the handlers of the program."""
    if threading.current_thread() is threading.main_thread():
        while _before:
            number, handler = _before.popitem()
            if signal.getsignal(number) is _handle:
                signal.signal(number, handler)


def shut_down_at_signals(context: Context, prepare: Callable[[], object]) -> None:
    """Call `prepare` and shut a context down when a signal comes."""
    _contexts[context] = prepare


def _handle(number: int, frame: FrameType | None) -> None:
    before = _before.get(number)
    # A thread, because the interrupted one may hold any lock.
    threading.Thread(target=_shut_down_all, daemon=True).start()
    if callable(before):
        before(number, frame)


def _shut_down_all() -> None:
    for context, prepare in list(_contexts.items()):
        prepare()
        context.try_shutdown()
