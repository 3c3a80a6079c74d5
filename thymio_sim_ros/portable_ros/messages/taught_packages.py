"""Packages of messages that only other programs have: clients send their definitions to the owner of the graph.

So programs of a workspace share types of their own by a server that runs elsewhere. A definition stays until the server
ends. What a client sends is bounded, because a short definition can stand for a message of any size.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Mapping

from thymio_sim_ros.portable_ros.messages.definition_text import DefinitionError, Shape
from thymio_sim_ros.portable_ros.messages.definitions import definition
from thymio_sim_ros.portable_ros.messages.interface_files import (
    FORMS,
    PACKAGES,
    interfaces,
    is_package,
    messages,
    sections,
)
from thymio_sim_ros.portable_ros.messages.own_packages import TAUGHT, check_names
from thymio_sim_ros.portable_ros.messages.packages import fill

__all__ = ["MOST_CHARACTERS", "MOST_VALUES", "definitions_for", "teach"]

MOST_CHARACTERS = 1_000_000
"""Characters of all definitions of clients together."""
MOST_VALUES = 100_000
"""Values of a message whose sequences are empty."""
_USED = re.compile(r"^\s*([a-z][a-z0-9_]*)/", re.MULTILINE)
"""The package of a type in a line of a definition."""


def definitions_for(package: str, known: set[str]) -> Iterator[tuple[str, Mapping[str, str]]]:
    """The packages of users that a package needs and that are not in `known`, itself last, with their texts.

    They are added to `known`. The texts are by `msg/Name`, `srv/Name` or `action/Name`.
    """
    if package in PACKAGES or package in known or not is_package(package):
        return
    known.add(package)
    texts = interfaces(package)
    for used in dict.fromkeys(_USED.findall("\n".join(texts.values()))):
        yield from definitions_for(used, known)
    yield package, texts


def teach(package: str, texts: Mapping[str, str]) -> None:
    """Add definitions of a package, as `definitions_for` has them; those that are known already must be the same.

    Raises DefinitionError, and adds nothing then.
    """
    known = interfaces(package) if is_package(package) else {}
    for name in known.keys() & texts.keys():
        if known[name] != texts[name]:
            raise DefinitionError(
                f"{package}/{name}: found another definition than that of the first program, expected the same:"
                " restart thymio-sim after a change"
            )
    added = {name: text for name, text in texts.items() if name not in known}
    if not added:
        return
    if known and package not in TAUGHT:
        raise DefinitionError(
            f"{package}/{next(iter(added))}: found a new definition, expected one that the folder of the package had"
            " when thymio-sim started: restart it"
        )
    check_names(package, added)
    before = TAUGHT.get(package)
    characters = sum(len(text) for each in TAUGHT.values() for text in each.values())
    if characters + sum(map(len, added.values())) > MOST_CHARACTERS:
        raise DefinitionError(f"{package}: found more than {MOST_CHARACTERS} characters of definitions of programs")
    _replace(package, {**known, **added})
    try:
        for name in added:
            for message in messages(f"{package}/{name}"):
                _count_values(message, ())
    except (DefinitionError, KeyError) as error:
        _replace(package, before)
        raise DefinitionError(str(error)) from error
    for form in FORMS:
        if (module := sys.modules.get(f"{package}.{form}")) is not None:
            fill(module)


def _replace(package: str, texts: Mapping[str, str] | None) -> None:
    if texts is None:
        TAUGHT.pop(package, None)
    else:
        TAUGHT[package] = texts
    for cached in (interfaces, sections, definition):
        cached.cache_clear()


def _count_values(name: str, around: tuple[str, ...]) -> int:
    """Return how many values a message has. Raises DefinitionError for too many, and for a message within itself."""
    if name in around:
        raise DefinitionError(f"{name}: found a message within itself, expected none")
    count = 1
    for field in definition(name).fields:
        inner = 1 if field.type.is_primitive else _count_values(field.type.base, (*around, name))
        count += inner * {Shape.SCALAR: 1, Shape.ARRAY: field.type.size, Shape.SEQUENCE: 0}[field.type.shape]
        if count > MOST_VALUES:
            raise DefinitionError(f"{name}: found more than {MOST_VALUES} values in a message, expected fewer")
    return count
