"""Names of nodes, topics and services: their rules, and how relative ones become full ones."""

from __future__ import annotations

import re

__all__ = ["NameProblem", "expanded", "full_topic_problem", "namespace_problem", "node_problem", "topic_problem"]

NameProblem = tuple[str, int] | None
"""What is wrong with a name, and the index of the character."""

_LONGEST_TOPIC = 255 - 8
_LONGEST_NAMESPACE = 245
_LONGEST_NODE = 255
_TOKEN_WITH_NUMBER = re.compile(r"/(?=\d)")


def topic_problem(name: str) -> NameProblem:
    """The problem of a name of a topic or service that may be relative and have substitutions.

    Raises TypeError for what is no text, and for half a character, which no UTF-8 has.
    """
    _check_unicode(name)
    if not name:
        return "topic name must not be empty string", 0
    if re.match(r"\d", name):
        return "topic name token must not start with a number", 0
    if name.endswith("/"):
        return "topic name must not end with a forward slash", len(name) - 1
    opened = -1
    for at, letter in enumerate(name):
        is_word = letter.isascii() and (letter.isalnum() or letter == "_")
        if opened >= 0 and letter != "}":
            if not is_word:
                return "substitution name must not contain characters other than alphanumerics or '_'", at
            if letter.isdigit() and at == opened + 1:
                return "substitution name must not start with a number", at
        elif letter == "{":
            opened = at
        elif letter == "}":
            if opened < 0:
                return "topic name must not have unmatched (unbalanced) curly braces '{}'", at
            opened = -1
        elif letter == "~":
            if at:
                return "topic name must not have tilde '~' unless it is the first character", at
        elif not is_word and letter != "/":
            return "topic name must not contain characters other than alphanumerics, '_', '~', '{', or '}'", at
    if opened >= 0:
        return "topic name must not have unmatched (unbalanced) curly braces '{}'", opened
    if found := _TOKEN_WITH_NUMBER.search(name):
        return "topic name token must not start with a number", found.end()
    return None


def full_topic_problem(name: str) -> NameProblem:
    """The problem of a full name of a topic or service."""
    problem = _full_problem(name, "topic name", "topic name must not end with a '/'", is_root_allowed=False)
    if problem is None and len(name) > _LONGEST_TOPIC:
        return "topic length should not exceed '255U - 8U'", _LONGEST_TOPIC - 1
    return problem


def namespace_problem(name: str) -> NameProblem:
    """The problem of a full namespace."""
    end = "namespace must not end with a '/', unless only a '/'"
    problem = _full_problem(name, "namespace", end, is_root_allowed=True)
    if problem is None and len(name) > _LONGEST_NAMESPACE:
        return "namespace should not exceed 'RMW_NAMESPACE_MAX_NAME_LENGTH'", _LONGEST_NAMESPACE - 1
    return problem


def _check_unicode(name: str) -> None:
    if not isinstance(name, str):
        raise TypeError(f"name: found {name!r}, expected a str")
    try:
        name.encode()
    except UnicodeEncodeError as error:
        raise TypeError(f"{name!r}: expected Unicode; {error}") from error


def _full_problem(name: str, what: str, end: str, *, is_root_allowed: bool) -> NameProblem:
    _check_unicode(name)
    if not name:
        return f"{what} must not be empty", 0
    if not name.startswith("/"):
        return f"{what} must be absolute, it must lead with a '/'", 0
    if name == "/" and is_root_allowed:
        return None
    if name.endswith("/"):
        return end, len(name) - 1
    if found := re.search(r"[^A-Za-z0-9_/]", name):
        return f"{what} must not contain characters other than alphanumerics, '_', or '/'", found.start()
    if (at := name.find("//")) >= 0:
        return f"{what} must not contain repeated '/'", at + 1
    if found := _TOKEN_WITH_NUMBER.search(name):
        return f"{what} must not have a token that starts with a number", found.end()
    return None


def node_problem(name: str) -> NameProblem:
    """The problem of a name of a node. Raises TypeError for one that is no text."""
    _check_unicode(name)
    if not name:
        return "node name must not be empty", 0
    if found := re.search(r"[^A-Za-z0-9_]", name):
        return "node name must not contain characters other than alphanumerics or '_'", found.start()
    if name[0].isdigit():
        return "node name must not start with a number", 0
    if len(name) > _LONGEST_NODE:
        return f"node name length should not exceed '{_LONGEST_NODE}'", _LONGEST_NODE - 1
    return None


def expanded(name: str, node: str, namespace: str) -> str:
    """The full name of a topic or service of a node.

    Raises TypeError for a name that is no text, and ValueError for one that is not valid, whose text ends with the
    reason.
    """
    if problem := topic_problem(name):
        raise ValueError(f"topic name '{name}' is invalid: {problem[0]}")
    space = namespace if namespace.endswith("/") else f"{namespace}/"
    known = {"node": f"{space}{node}", "ns": namespace, "namespace": namespace}

    def substituted(found: re.Match[str]) -> str:
        if found[1] not in known:
            raise ValueError(f"topic name '{name}' is invalid: unknown substitution: {found[0]}")
        return known[found[1]]

    if name.startswith("~"):
        name = f"{space}{node}{name[1:]}"
    result = re.sub(r"\{(\w*)\}", substituted, name)
    return result if result.startswith("/") else f"{space}{result}"
