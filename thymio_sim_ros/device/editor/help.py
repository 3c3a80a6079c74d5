"""One line of help for each variable, native and local event of the Thymio, from `languages/<code>/help.json`.

Facts: docs/spec/thymio-robot.md sections 4 to 6.
"""

from __future__ import annotations

from aseba_vm.languages import ENGLISH, texts

__all__ = ["help_of"]


def help_of(kind: str, name: str, language: str = ENGLISH, *, other: str = "") -> str:
    """Help for a name of one `kind` (variables, natives, events); `other` where no table knows it, as for plug-ins."""
    return texts("help", language).get(f"{kind}.{name}", other)
