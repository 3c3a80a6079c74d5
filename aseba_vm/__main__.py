"""The command line: ``python -m aseba_vm check | compile | dis | run | fmt``, also installed as ``aseba``.

Exit codes: 0 done, 1 the program is wrong or stopped with a fault, 2 the command line or a file is wrong.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from aseba_vm import aesl
from aseba_vm.bytecode import describe, disassemble
from aseba_vm.compiler import Program, Stages, assemble, compile_stages
from aseba_vm.errors import AeslError, AsebaError, CompileError, TargetError
from aseba_vm.excerpt import excerpt
from aseba_vm.layout import formatted
from aseba_vm.outbox import Emitted, NativeCalled
from aseba_vm.target import TargetDescription
from aseba_vm.targets import THYMIO_II
from aseba_vm.vm import VirtualMachine

DONE = 0
WRONG_PROGRAM = 1
WRONG_USE = 2

_STAGES = ("tokens", "tree", "expanded", "optimised", "code", "words")

_EXAMPLES = """\
examples:
  aseba check robot.aesl
  aseba compile robot.aesl --format json -o robot.json
  aseba dis robot.aesl --stage tree
  aseba run count.aseba --global ping=1 --raise ping=5 --show n
  aseba fmt --write robot.aesl

Without installation: python -m aseba_vm check robot.aesl

A file is an .aesl file if it begins with '<', else the bare text of a program; '-' is the standard input.
exit codes: 0 done, 1 the program is wrong or stopped with a fault, 2 wrong use or unreadable file.
"""


@dataclass(frozen=True, slots=True)
class _Source:
    """A program and what it is compiled with; ``row`` and ``col`` are where it begins in its file."""

    name: str
    text: str
    events: tuple[tuple[str, int], ...]
    constants: tuple[tuple[str, int], ...]
    row: int = 0
    col: int = 0


class _UseError(Exception):
    """A command line that cannot be obeyed."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Obey a command line and return the exit code."""
    options = _parser().parse_args(arguments)
    command: Callable[[argparse.Namespace], int] = options.command
    try:
        return command(options)
    except AsebaError as error:
        print(error if isinstance(error, TargetError) else _told(error, options), file=sys.stderr)
        return WRONG_USE if isinstance(error, TargetError) else WRONG_PROGRAM
    except (_UseError, OSError, UnicodeDecodeError) as error:
        print(f"aseba: {error}", file=sys.stderr)
        return WRONG_USE


# -- commands ----------------------------------------------------------------------------------------------------------


def _check(options: argparse.Namespace) -> int:
    _compile_source(options, _read(options), with_warnings=True)
    return DONE


def _compile(options: argparse.Namespace) -> int:
    program = _compile_source(options, _read(options), with_warnings=True)
    if options.format == "json":
        text = json.dumps(_as_data(program)) + "\n"
    elif options.format == "hex":
        text = "".join(f"{word:04x}\n" for word in program.words)
    else:
        text = disassemble(program.words) + "\n"
    if options.output is None:
        sys.stdout.write(text)
    else:
        Path(options.output).write_text(text, encoding="utf-8")
    return DONE


def _dis(options: argparse.Namespace) -> int:
    source = _read(options)
    if options.stage == "words":
        print(disassemble(_compile_source(options, source).words))
    else:
        print(_stages(options, source).dump(options.stage))
    return DONE


def _run(options: argparse.Namespace) -> int:
    source = _read(options)
    target = _target(options)
    program = _compile_source(options, source)
    machine = VirtualMachine(target)
    machine.load(program)
    if options.trace:
        machine.tracer = partial(_trace, machine, program, source)
    _execute(machine, program, source, options)
    for name, values in options.raised:
        numbers = [number for number, (event, _) in enumerate(source.events) if event == name]
        if numbers:
            machine.receive(numbers[-1], machine.node_id, values)
        elif name in (event.name for event in target.local_events):
            machine.start_local(0xFFFE - target.local_event_number(name))
        else:
            raise _UseError(f"no event is called {name!r}")
        _execute(machine, program, source, options)
    addresses = target.addresses | program.addresses
    for name in options.show or list(program.addresses):
        if name not in addresses:
            raise _UseError(f"no variable is called {name!r}")
        address, size = addresses[name]
        print(name, *machine.variables[address : address + size])
    return DONE if machine.fault is None else WRONG_PROGRAM


def _execute(machine: VirtualMachine, program: Program, source: _Source, options: argparse.Namespace) -> None:
    """Run the active event to its end or to the limit, and tell what it said."""
    machine.run(options.limit)
    for message in machine.take_messages():
        if isinstance(message, Emitted):
            print("emit", source.events[message.number][0], *message.arguments)
        elif isinstance(message, NativeCalled):
            print("call", message.name, *(word for _, _, words in message.arguments for word in words))
    fault = machine.fault
    if fault is not None:
        row = program.row_of(fault.pc)
        place = options.file if row is None else f"{options.file}:{source.row + row + 1}"
        print(f"{place}: stopped: {fault.sentence}", file=sys.stderr)
    elif machine.is_active:
        print(f"{options.file}: still running after {options.limit} instructions", file=sys.stderr)
        machine.stop()


def _trace(machine: VirtualMachine, program: Program, source: _Source, pc: int) -> None:
    """Show an instruction that is about to be executed: address, line, instruction, stack."""
    row = program.row_of(pc)
    line = "" if row is None else source.row + row + 1
    stack = " ".join(map(str, machine.stack[: machine.sp + 1]))
    print(f"{pc:5} {line:>5}  {describe(machine.bytecode[pc : pc + 3]):32} [{stack}]")


def _fmt(options: argparse.Namespace) -> int:
    text = options.text = _text(options.file)
    if _is_aesl(text):
        network = aesl.loads(text)
        nodes = tuple(replace(node, code=formatted(node.code)) for node in network.nodes)
        result = aesl.dumps(replace(network, nodes=nodes))
    else:
        result = formatted(text)
    if options.check:
        return DONE if result == text else WRONG_PROGRAM
    if options.write and options.file != "-":
        Path(options.file).write_text(result, encoding="utf-8")
    else:
        sys.stdout.write(result)
    return DONE


# -- files -------------------------------------------------------------------------------------------------------------


def _text(name: str) -> str:
    data = sys.stdin.buffer.read() if name == "-" else Path(name).read_bytes()
    return data.decode("utf-8-sig")


def _is_aesl(text: str) -> bool:
    return text.lstrip().startswith("<")


def _read(options: argparse.Namespace) -> _Source:
    text = options.text = _text(options.file)
    events, constants = tuple(options.events), tuple(options.constants)
    if not _is_aesl(text):
        return _Source(options.file, text, events, constants)
    network = aesl.loads(text)
    name = options.node or _target(options).name
    node = network.node(name)
    if node is None:
        found = ", ".join(node.name for node in network.nodes) or "none"
        raise _UseError(f"{options.file}: no program for a node called {name!r} (found: {found})")
    return _Source(options.file, node.code, network.events + events, network.constants + constants, node.row, node.col)


def _target(options: argparse.Namespace) -> TargetDescription:
    if options.target is None:
        return THYMIO_II
    try:
        return TargetDescription.from_data(json.loads(_text(options.target)))
    except json.JSONDecodeError as error:
        raise TargetError(f"{options.target}: not JSON: {error}") from error


def _stages(options: argparse.Namespace, source: _Source) -> Stages:
    """Compile, with errors placed in the file rather than in the program."""
    try:
        return compile_stages(source.text, _target(options), source.events, source.constants)
    except CompileError as error:
        pos = None if error.pos is None else error.pos.moved(source.row, source.col)
        raise CompileError(error.kind, error.arguments, pos) from error


def _compile_source(options: argparse.Namespace, source: _Source, *, with_warnings: bool = False) -> Program:
    program = assemble(_stages(options, source), _target(options))
    if with_warnings:
        for warning in program.warnings:
            moved = replace(warning, pos=warning.pos.moved(source.row, source.col))
            print(
                moved.located(options.file), _excerpt(options, moved.pos.row, moved.pos.col), sep="\n", file=sys.stderr
            )
    return program


def _told(error: AsebaError, options: argparse.Namespace) -> str:
    """The error with its place, and the line there."""
    match error:
        case CompileError(pos=None):
            return error.located(options.file)
        case CompileError(pos=pos) if pos is not None:
            return f"{error.located(options.file)}\n{_excerpt(options, pos.row, pos.col)}"
        case AeslError():
            return f"{error.located(options.file)}\n{_excerpt(options, error.line - 1, error.column - 1)}"
    return str(error)


def _excerpt(options: argparse.Namespace, row: int, col: int) -> str:
    return excerpt(options.text, row, col, is_coloured=sys.stderr.isatty() and "NO_COLOR" not in os.environ)


def _as_data(program: Program) -> dict[str, object]:
    return {
        "words": program.words,
        "lines": program.lines,
        "variables": [[variable.name, variable.address, variable.size] for variable in program.variables],
        "events": [[event.number, event.address, event.name] for event in program.events],
        "subs": [[sub.name, sub.address, sub.row] for sub in program.subs],
        "allocated": program.allocated,
        "stack": program.stack,
    }


# -- options -----------------------------------------------------------------------------------------------------------


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="aseba",
        description="Compile, inspect, run and format Aseba programs.",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    check = _command(commands, "check", _check, "report the first error, or warnings")
    compiling = _command(commands, "compile", _compile, "write the bytecode")
    compiling.add_argument("--format", choices=("hex", "json", "listing"), default="hex", help="default: %(default)s")
    compiling.add_argument("-o", "--output", metavar="FILE", help="default: standard output")
    dis = _command(commands, "dis", _dis, "show the bytecode or another stage of the compiler")
    dis.add_argument("--stage", choices=_STAGES, default="words", help="default: %(default)s")
    run = _command(commands, "run", _run, "execute the initialisation and events, then show variables")
    run.add_argument(
        "--raise",
        dest="raised",
        metavar="EVENT[=VALUES]",
        type=_raised,
        action="append",
        default=[],
        help="event to raise afterwards, with values between commas (may be repeated)",
    )
    run.add_argument("--show", metavar="VARIABLE", action="append", help="default: all variables of the program")
    run.add_argument("--trace", action="store_true", help="show each instruction: address, line, stack before it")
    limit_help = "instructions of one event, default: %(default)s"
    run.add_argument("--limit", metavar="N", type=_positive, default=1_000_000, help=limit_help)
    fmt = commands.add_parser("fmt", help="indent the source", description="Indent the source regularly.")
    fmt.set_defaults(command=_fmt)
    fmt.add_argument("file", metavar="FILE")
    fmt.add_argument("--write", action="store_true", help="change the file")
    fmt.add_argument("--check", action="store_true", help="change nothing; exit code 1 if the file would change")
    for command in (check, compiling, dis, run):
        command.add_argument("file", metavar="FILE", help=".aesl file, bare program text, or -")
        command.add_argument("--target", metavar="FILE", help="target description in JSON, default: Thymio II")
        command.add_argument("--node", metavar="NAME", help="node of the .aesl file, default: that of the target")
        command.add_argument(
            "--global",
            dest="events",
            metavar="NAME=WORDS",
            type=_pair,
            action="append",
            default=[],
            help="a global event (may be repeated)",
        )
        command.add_argument(
            "--constant",
            dest="constants",
            metavar="NAME=VALUE",
            type=_pair,
            action="append",
            default=[],
            help="a constant (may be repeated)",
        )
    return parser


def _command(
    commands: argparse._SubParsersAction[argparse.ArgumentParser],
    name: str,
    function: Callable[[argparse.Namespace], int],
    about: str,
) -> argparse.ArgumentParser:
    command = commands.add_parser(name, help=about, description=f"{about[0].upper()}{about[1:]}.")
    command.set_defaults(command=function)
    return command


def _positive(text: str) -> int:
    if int(text) < 1:
        raise ValueError(text)
    return int(text)


def _pair(text: str) -> tuple[str, int]:
    name, _, value = text.rpartition("=")
    if not name:
        raise ValueError(text)
    return name, int(value)


def _raised(text: str) -> tuple[str, list[int]]:
    name, _, values = text.partition("=")
    return name, [int(value) for value in values.split(",")] if values else []


if __name__ == "__main__":
    sys.exit(main())
