"""The language service for editors: what a program can use, and the findings of the compiler about a text.

Everything is plain data, ready for JSON; docs/aseba_ros.md names the fields. Nothing here changes a device.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

from aseba_vm import AeslError, CompileError, Program, SourcePos, aesl, compile
from aseba_vm.aesl.reader import MAX_EVENT_WORDS
from aseba_vm.errors import Hint
from aseba_vm.frontend.identifiers import LETTER_OR_DIGIT
from aseba_vm.frontend.lexer import KEYWORDS
from aseba_vm.languages import ENGLISH, texts
from aseba_vm.messages import format_message
from aseba_vm.vm import MAX_BREAKPOINTS
from thymio_sim_ros.device.editor.help import help_of
from thymio_sim_ros.device.editor.help_order import OTHERS, TOPICS, rank, topic_of
from thymio_sim_ros.device.editor.symbol_outline import outline
from thymio_sim_ros.device.layout import THYMIO, target
from thymio_sim_ros.device.programs.program import (
    ThymioProgram,
    is_skipped,
    memory_use,
    other_device_note,
    parse,
    select,
)

__all__ = [
    "MOST_CHARACTERS",
    "Question",
    "check",
    "describe_program",
    "describe_target",
    "doubts",
    "refusal",
]

MOST_CHARACTERS = 64_000
"""Longest text that is checked: several programs that fill a Thymio. Longer ones would take more than a second."""

_WORD = re.compile(rf"[{LETTER_OR_DIGIT}_.]+")


@dataclass(frozen=True, slots=True)
class Question:
    """A text to check; bare text may bring the events (name, size) and constants (name, value) of its network."""

    source: str
    layout: str = THYMIO
    language: str = ENGLISH
    events: tuple[tuple[str, int], ...] = ()
    constants: tuple[tuple[str, int], ...] = ()
    robots: tuple[str, ...] = ()


def check(question: Question) -> dict[str, Any]:
    """Errors, warnings, names and use of the memories; `errors` is empty when the text compiles."""
    if len(question.source) > MOST_CHARACTERS:
        text = f"found {len(question.source)} characters, expected at most {MOST_CHARACTERS}"
        return refusal(text)
    try:
        network = parse(question.source)
    except AeslError as error:
        sentence = _sentence(error.kind, error.arguments, question.language)
        return _answer([_finding(error.kind, sentence, error.line, error.column, 1, "") | {"hint": None}])
    if not aesl.is_aesl(question.source):
        network = replace(network, events=question.events, constants=question.constants)
    selection = select(network, question.robots)
    answer = _answer(
        events=[{"name": name, "size": size} for name, size in network.events],
        constants=[{"name": name, "value": value} for name, value in network.constants],
    )
    for node in selection.nodes:
        errors, warnings, report = _check_node(node, network, question)
        if errors and is_skipped(node, selection):
            answer["notes"].append(_note("note-left-out-node", node, question, errors[0]["message"]))
            continue
        if node in selection.guessed:
            kind = "note-only-node" if len(selection.nodes) == 1 else "note-guessed-node"
            answer["notes"].append(_note(kind, node, question))
        answer["errors"] += errors
        answer["warnings"] += warnings
        answer["nodes"].append(report)
    return answer


def describe_target(layout: str = THYMIO, language: str = ENGLISH) -> dict[str, Any]:
    """Return what a program for this layout can use, the most useful first, and its limits.

    `topics`: topics of the help, in the order in which it lists them.
    """
    memory = target(layout)
    return {
        "name": memory.name,
        "layout": layout,
        "language": language,
        "variables": [
            {
                "name": variable.name,
                "size": variable.size,
                "address": memory.addresses[variable.name][0],
                "hidden": is_hidden(variable.name),
                "topic": topic_of(variable.name),
                "help": help_of("variables", variable.name, language),
            }
            for variable in sorted(memory.variables, key=lambda variable: _rank("variables", variable.name))
        ],
        "events": [
            {
                "name": event.name,
                "topic": topic_of(event.name),
                "help": help_of("events", event.name, language, other=event.description),
            }
            for event in sorted(memory.local_events, key=lambda event: _rank("events", event.name))
        ],
        "natives": [
            {
                "name": native.name,
                "parameters": [{"name": parameter.name, "size": parameter.size} for parameter in native.parameters],
                "hidden": is_hidden(native.name),
                "topic": topic_of(native.name),
                "help": help_of("natives", native.name, language, other=native.description),
            }
            for native in sorted(memory.natives, key=lambda native: _rank("natives", native.name))
        ],
        "topics": [*TOPICS, OTHERS],
        "keywords": sorted(KEYWORDS),
        "limits": {
            "variables": memory.variables_size,
            "bytecode": memory.bytecode_size,
            "stack": memory.stack_size,
            "event_values": MAX_EVENT_WORDS,
            "breakpoints": MAX_BREAKPOINTS,
            "check_characters": MOST_CHARACTERS,
        },
    }


def describe_program(program: ThymioProgram, topics: Mapping[str, str]) -> dict[str, Any]:
    """A loaded program; `topics`: the words that its events have in topic names."""
    return {
        "name": program.name,
        "foreign": program.is_foreign,
        "node": program.node.name,
        "first_line": program.lines[0],
        "source": program.source,
        "file": program.text,
        "events": [{"name": name, "size": size, "topic": topics.get(name)} for name, size in program.events],
        "constants": [{"name": name, "value": value} for name, value in program.constants],
        **_names(program.node, program.program),
    }


def doubts(program: ThymioProgram, language: str = ENGLISH) -> list[dict[str, Any]]:
    """The compiler's warnings about a program."""
    return _doubts(program.node, program.program, language)


def is_hidden(name: str) -> bool:
    """Whether a name is for experts: one of its parts begins with `_`."""
    return name.startswith("_") or "._" in name


def _rank(kind: str, name: str) -> int:
    return rank(kind, name, hidden=is_hidden(name))


def refusal(text: str) -> dict[str, Any]:
    """The answer to a request that cannot be answered."""
    return _answer([_finding("request", text, None, None, 0, "") | {"hint": None}])


def _answer(
    errors: Sequence[dict[str, Any]] = (),
    events: Sequence[dict[str, Any]] = (),
    constants: Sequence[dict[str, Any]] = (),
) -> dict[str, Any]:
    return {
        "errors": list(errors),
        "warnings": [],
        "notes": [],
        "events": list(events),
        "constants": list(constants),
        "nodes": [],
    }


def _check_node(
    node: aesl.Node, network: aesl.Network, question: Question
) -> tuple[list[dict[str, Any]], list[dict[str, Any]], dict[str, Any]]:
    errors, warnings = [], []
    program = None
    try:
        program = compile(node.code, target(question.layout), events=network.events, constants=network.constants)
    except CompileError as error:
        sentence = _sentence(error.kind, error.arguments, question.language)
        sentence += other_device_note(node, texts("compiler", question.language))
        finding = _placed(node, error.kind, sentence, error.pos)
        errors.append(finding | {"hint": _hint(node, error.hint, question.language)})
    else:
        warnings = _doubts(node, program, question.language)
    report = {
        "name": node.name,
        "id": node.node_id,
        "first_line": node.place(0)[0] + 1,
        "compiles": program is not None,
        **_names(node, program),
        "use": None if program is None else memory_use(program, question.layout),
    }
    return errors, warnings, report


def _note(kind: str, node: aesl.Node, question: Question, *arguments: str) -> dict[str, Any]:
    """Return an assumption about a node as a finding at its code."""
    row, column = node.place(0)
    sentence = _sentence(kind, (node.name, *arguments), question.language)
    return _finding(kind, sentence, row + 1, column + 1, 0, node.name)


def _names(node: aesl.Node, program: Program | None) -> dict[str, Any]:
    found = outline(node)
    places = {} if program is None else program.addresses
    unknown = (None, None)
    return {
        "variables": [
            asdict(symbol) | dict(zip(("address", "size"), places.get(symbol.name, unknown), strict=True))
            for symbol in found["var"]
        ],
        "subroutines": [asdict(symbol) for symbol in found["sub"]],
        "handlers": [asdict(symbol) for symbol in found["onevent"]],
    }


def _doubts(node: aesl.Node, program: Program, language: str) -> list[dict[str, Any]]:
    return [
        _placed(node, doubt.kind, _sentence(doubt.kind, doubt.arguments, language), doubt.pos)
        for doubt in program.warnings
    ]


def _placed(node: aesl.Node, kind: str, sentence: str, pos: SourcePos | None) -> dict[str, Any]:
    if pos is None:
        return _finding(kind, sentence, None, None, 0, node.name)
    row, column = node.place(pos.offset)
    word = _WORD.match(node.code, pos.offset)
    length = 1 if word is None else word.end() - word.start()
    return _finding(kind, sentence, row + 1, column + 1, length, node.name)


def _hint(node: aesl.Node, hint: Hint | None, language: str) -> dict[str, Any] | None:
    """Return a hint with the places of its edit in the file; the text of the edit is program text."""
    if hint is None:
        return None
    edit = None
    if hint.edit is not None:
        row, column = node.place(hint.edit.start)
        end_row, end_column = node.place(hint.edit.end)
        edit = {
            "line": row + 1,
            "column": column + 1,
            "end_line": end_row + 1,
            "end_column": end_column + 1,
            "text": hint.edit.text,
        }
    sentence = hint.message(texts("compiler", language), node.rows_in_file())
    return {"kind": hint.kind, "message": sentence, "edit": edit}


def _finding(kind: str, sentence: str, line: int | None, column: int | None, length: int, node: str) -> dict[str, Any]:
    return {"line": line, "column": column, "length": length, "message": sentence, "kind": kind, "node": node}


def _sentence(kind: str, arguments: Collection[Any], language: str) -> str:
    return format_message(kind, tuple(arguments), texts("compiler", language))
