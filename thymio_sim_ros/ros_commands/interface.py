"""The verbs of interfaces."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Iterator, Mapping

from thymio_sim_ros.ros.foxglove.schemas import SEPARATOR, definitions
from thymio_sim_ros.ros_commands.errors import CommandError
from thymio_sim_ros.ros_commands.member import Member, load

__all__ = ["VERBS"]

_FORMS = ("msg", "srv", "action")
_TYPE = re.compile(r"([A-Za-z][\w/]*)")


def _show(_member: Member, options: argparse.Namespace) -> None:
    package, _, rest = options.type.partition("/")
    form, _, short = rest.partition("/")
    if form not in _FORMS or not short:
        raise CommandError(f"found type {options.type}, expected one such as std_msgs/msg/String")
    load(options.type, form)
    texts = (_shown(text, package) for text in definitions(options.type))
    print("---\n".join("".join(f"{line}\n" for line in lines) for lines in texts), end="")


def _shown(text: str, package: str) -> Iterator[str]:
    """The lines of a complete definition, with the fields of each type that it uses below that."""
    root, *others = text.split(f"\n{SEPARATOR}\n")
    used = {name.removeprefix("MSG: "): lines for name, _, lines in (other.partition("\n") for other in others)}
    for line in root.rstrip("\n").splitlines():
        yield line
        yield from _below(line, package, used, "\t")


def _below(line: str, package: str, used: Mapping[str, str], indent: str) -> Iterator[str]:
    found = _TYPE.match(line)
    name = found[1] if found else ""
    full = name if "/" in name else f"{package}/{name}"
    for inner in used.get(full, "").splitlines():
        field = inner.partition("#")[0].rstrip()
        if field:
            yield f"{indent}{field}"
            yield from _below(field, full.partition("/")[0], used, f"{indent}\t")


VERBS: Mapping[str, Callable[[Member, argparse.Namespace], None]] = {"show": _show}
