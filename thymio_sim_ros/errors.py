"""The base class of all exceptions of this package: `except ThymioSimError` catches every error that it raises itself.

Each subpackage defines its own exceptions below it. Where callers expect a built-in exception too, the class has both
bases (`OptionError(ThymioSimError, ValueError)`). The compiler and the virtual machine are a package of their own with
their own base, `aseba_vm.AsebaError`.
"""

from __future__ import annotations

__all__ = ["ThymioSimError"]


class ThymioSimError(Exception):
    """Input that is rejected, or an operation that is impossible; the message is meant for the user."""
