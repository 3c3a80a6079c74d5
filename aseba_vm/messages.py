"""Sentences for errors, warnings and hints, from the texts in `languages/<code>/compiler.json`.

Kinds and arguments come from the errors. In a template, `{0}` is an argument, `{t0}` a token, `{l0}` a list of
tokens, `{v0}` a token with its value.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from aseba_vm.languages import texts

MESSAGES: Mapping[str, str] = texts("compiler")
"""Kind of message → English template."""

_LONGEST = 60
"""Letters of a name that are shown; longer names are truncated."""


def format_message(kind: str, arguments: Sequence[object], messages: Mapping[str, str] = MESSAGES) -> str:
    """The text of an error, warning or hint; for an unknown kind, the kind itself with its arguments."""
    template = messages.get(kind, MESSAGES.get(kind))
    if template is None:
        return " ".join([kind, *map(str, arguments)])
    words: dict[str, str] = {}
    arguments = [_shortened(argument) for argument in arguments]
    for index, argument in enumerate(arguments):
        if isinstance(argument, tuple):
            words[f"l{index}"] = ", ".join(_token(messages, kind) for kind in argument)
            words[f"v{index}"] = _valued_token(messages, *argument)
        else:
            words[f"t{index}"] = _token(messages, argument)
    return template.format(*arguments, **words)


def _shortened(argument: object) -> object:
    if isinstance(argument, tuple):
        return tuple(map(_shortened, argument))
    return f"{argument[:_LONGEST]}…" if isinstance(argument, str) and len(argument) > _LONGEST else argument


def _token(messages: Mapping[str, str], kind: object) -> str:
    known = f"token-{kind}"
    return messages.get(known, MESSAGES.get(known, f"'{kind}'"))


def _valued_token(messages: Mapping[str, str], kind: object, value: object = None, *_: object) -> str:
    known = f"valued-{kind}"
    template = messages.get(known, MESSAGES.get(known))
    return _token(messages, kind) if value is None or template is None else template.format(value)
