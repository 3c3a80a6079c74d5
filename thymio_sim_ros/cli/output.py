"""Standard output of the commands. An error of writing names standard output as its file."""

from __future__ import annotations

import json
from collections.abc import Mapping

from aseba_vm.cli.output import standard_output

__all__ = ["print_json", "print_text"]


def print_text(text: str) -> None:
    """Print a text. Raises OSError if standard output cannot be written."""
    with standard_output():
        print(text)


def print_json(result: Mapping[str, object]) -> None:
    """Print the result of a command. Raises OSError if standard output cannot be written."""
    print_text(json.dumps(result, indent=2))
