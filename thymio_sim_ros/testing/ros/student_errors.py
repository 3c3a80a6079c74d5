"""StudentError: what is wrong with code under test, in the words of its failure."""

from __future__ import annotations

import sys

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.testing.ros import interruption

__all__ = ["INSTEAD", "StudentError", "never_ends"]

INSTEAD = (
    "expected: a timer, add_done_callback, or await in a callback; a program with a multi-threaded executor or with"
    " threads, whose callbacks may wait, is tested with ros.run"
)


class StudentError(ThymioSimError):
    """A file, module or class has no node that can be started, or the node does what no node may do; the text says
    what.
    """


def never_ends(wait: str) -> StudentError:
    """The failure for a wait that the code that calls this is about to begin."""
    where = interruption.place(sys._getframe(1))
    return StudentError(
        f"deadlock: {wait} in a constructor or callback never ends, since only the test lets messages come and time"
        f" pass{where}\n  {INSTEAD}"
    )
