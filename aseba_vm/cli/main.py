"""The command line: `python -m aseba_vm check | compile | dis | run | fmt`, also installed as `aseba`.

Exit codes: 0 done, 1 the program has an error or stopped with a fault, 2 wrong usage or unreadable file.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import sys
from collections.abc import Callable, Sequence
from functools import partial

from aseba_vm.aesl.reader import MAX_EVENT_WORDS
from aseba_vm.bytecode import describe
from aseba_vm.cli import check_and_format
from aseba_vm.cli.inputs import Source, SourceError, network_of, read_text, sources_of
from aseba_vm.cli.listing import listing
from aseba_vm.cli.output import exit_by_signal, open_standard_streams, standard_output, write_file
from aseba_vm.cli.report import (
    WARNING,
    Finding,
    finding_of_compile_error,
    finding_of_text_error,
    is_colored,
    user_language,
)
from aseba_vm.errors import AeslError, CompileError, TargetError, TextError
from aseba_vm.frontend.lexer import is_name
from aseba_vm.frontend.pipeline import Program, assemble
from aseba_vm.languages import LANGUAGES, texts
from aseba_vm.machine.machine_messages import Emitted, NativeCalled
from aseba_vm.messages import format_message
from aseba_vm.target import TargetDescription
from aseba_vm.targets import THYMIO_II
from aseba_vm.vm import VirtualMachine

DONE = 0
WRONG_PROGRAM = 1
WRONG_USE = 2

_STAGES = ("tokens", "tree", "expanded", "optimized", "code", "words")

_EXAMPLES = """\
examples:
  aseba check robot.aesl
  aseba check programs/ more.aesl --lang de
  aseba compile robot.aesl --format json -o robot.json
  aseba dis robot.aesl --stage tree
  aseba run count.aseba --global ping=1 --raise ping=5 --show n
  aseba fmt --write robot.aesl programs/

Without installation: python -m aseba_vm check robot.aesl

A file that begins with '<' is an .aesl file, any other file is the plain text of a program; '-' is the standard input.
check and fmt process all *.aesl and *.aseba files in a folder and its subfolders.
exit codes: 0 done, 1 a program has an error or stopped with a fault, 2 wrong usage or unreadable file.
"""


class _UseError(Exception):
    """An invalid command line."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Execute a command line and return the exit code.

    Errors are printed, not raised, except SystemExit for `--help` and invalid options.
    """
    open_standard_streams()
    options = _parser().parse_args(arguments)
    command: Callable[[argparse.Namespace], int] = options.command
    options.text = ""
    options.language = options.lang or user_language(os.environ)
    try:
        with standard_output():
            return command(options)
    except SourceError as error:
        _print(options, finding_of_compile_error(error.source, error.error, texts("compiler", options.language)))
        return WRONG_PROGRAM
    except AeslError as error:
        _print(options, finding_of_text_error(options.file, error, texts("compiler", options.language)))
        return WRONG_USE if error.kind == "aesl-other-robot" else WRONG_PROGRAM
    except TextError as error:
        _print(options, finding_of_text_error(options.file, error, texts("compiler", options.language)))
    except BrokenPipeError:
        pass  # the reader of the output has closed it
    except OSError as error:
        print(f"aseba: {error.filename}: {error.strerror}", file=sys.stderr)
    except (_UseError, TargetError) as error:
        print(f"aseba: {error}", file=sys.stderr)
    except KeyboardInterrupt:
        exit_by_signal(signal.SIGINT)
    return WRONG_USE


# -- commands ----------------------------------------------------------------------------------------------------------


def _check(options: argparse.Namespace) -> int:
    return check_and_format.check(options, _target(options))


def _compile(options: argparse.Namespace) -> int:
    source = _read(options)[0]
    program = _compile_source(options, source, with_warnings=True)
    if options.format == "json":
        text = json.dumps(_as_data(program)) + "\n"
    elif options.format == "hex":
        text = "".join(f"{word:04x}\n" for word in program.words)
    else:
        text = _listing(options, source, program)
    if options.output is None:
        sys.stdout.write(text)
    else:
        write_file(options.output, text.encode())
    return DONE


def _listing(options: argparse.Namespace, source: Source, program: Program) -> str:
    numbers = [row + 1 for row in source.node.rows_in_file()]
    return listing(program, source.node.code, _target(options), source.events, numbers) + "\n"


def _dis(options: argparse.Namespace) -> int:
    source = _read(options)[0]
    if options.stage == "words":
        sys.stdout.write(_listing(options, source, _compile_source(options, source)))
    else:
        print(source.stages(_target(options)).dump(options.stage))
    return DONE


def _run(options: argparse.Namespace) -> int:
    source = _read(options)[0]
    target = _target(options)
    program = _compile_source(options, source)
    machine = VirtualMachine(target)
    machine.load(program)
    if options.trace:
        machine.tracer = partial(_trace, machine, program, source.node.rows_in_file())
    _execute(machine, program, source, options)
    for name, values in options.raised:
        numbers = [number for number, (event, _) in enumerate(source.events) if event == name]
        is_local = name in (event.name for event in target.local_events)
        if not numbers and not is_local:
            raise _UseError(f"no event is called {name!r}")
        if machine.is_step_by_step:
            break  # it has stopped and accepts no more events
        if is_local:  # it hides a global event of the same name, as in programs
            machine.start_local(0xFFFE - target.local_event_number(name))
        else:
            machine.receive(numbers[-1], machine.node_id, values)
        _execute(machine, program, source, options)
    addresses = target.addresses | program.addresses
    for name in options.show or list(program.addresses):
        if name not in addresses:
            raise _UseError(f"no variable is called {name!r}")
        address, size = addresses[name]
        print(name, *machine.variables[address : address + size])
    return DONE if machine.fault is None else WRONG_PROGRAM


def _execute(machine: VirtualMachine, program: Program, source: Source, options: argparse.Namespace) -> None:
    """Run the active event to its end or to the limit, and print its messages."""
    machine.run(options.limit)
    for message in machine.pop_messages():
        if isinstance(message, Emitted):
            print("emit", source.events[message.number][0], *message.arguments)
        elif isinstance(message, NativeCalled):
            print("call", message.name, *(word for _, _, words in message.arguments for word in words))
    fault = machine.fault
    if fault is not None:
        row = program.row_of(fault.pc)
        place = options.file if row is None else f"{options.file}:{source.node.rows_in_file()[row] + 1}"
        print(f"{place}: stopped: {fault.message_in(options.language)}", file=sys.stderr)
    elif machine.is_active:
        print(f"{options.file}: still running after {options.limit} instructions", file=sys.stderr)
        machine.stop()


def _trace(machine: VirtualMachine, program: Program, rows: Sequence[int], pc: int) -> None:
    """Print the instruction about to be executed: address, line, instruction, stack."""
    row = program.row_of(pc)
    line = "" if row is None else rows[row] + 1
    stack = " ".join(map(str, machine.stack[: machine.sp + 1]))
    print(f"{pc:5} {line:>5}  {describe(machine.bytecode[pc : pc + 3]):32} [{stack}]")


# -- files -------------------------------------------------------------------------------------------------------------


def _read(options: argparse.Namespace) -> list[Source]:
    """The programs of the file for the selected node, or for the target."""
    options.text = read_text(options.file).text
    kind = _target(options).name
    network = network_of(options.text, options.node or kind)
    return sources_of(network, options.file, kind, options.node, options.events, options.constants)


def _target(options: argparse.Namespace) -> TargetDescription:
    if options.target is None:
        return THYMIO_II
    try:
        return TargetDescription.from_data(json.loads(read_text(options.target).text))
    except TextError as error:
        raise TargetError(error.located(options.target)) from error
    except (ValueError, RecursionError) as error:
        raise TargetError(f"{options.target}: not JSON: {error}") from error
    except TargetError as error:
        raise TargetError(f"{options.target}: {error}") from error


def _compile_source(options: argparse.Namespace, source: Source, *, with_warnings: bool = False) -> Program:
    try:
        program = assemble(source.stages(_target(options)), _target(options))
    except CompileError as error:
        raise SourceError(source, error) from error
    for warning in program.warnings if with_warnings else ():
        row, col = source.place(warning.pos.offset)
        sentence = format_message(warning.kind, warning.arguments, texts("compiler", options.language))
        _print(options, Finding(options.file, row + 1, col + 1, WARNING, warning.kind, sentence))
    return program


def _print(options: argparse.Namespace, finding: Finding) -> None:
    label = format_message("label-hint", (), texts("compiler", options.language))
    print(finding.text(options.text, label=label, is_colored=is_colored()), file=sys.stderr)


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
    check = _command(commands, "check", _check, "report the first error of each program, or warnings")
    check.add_argument(
        "--format",
        choices=("text", "json"),
        default="text",
        help="json: all findings on the standard output; default: %(default)s",
    )
    compiling = _command(commands, "compile", _compile, "write the bytecode")
    compiling.add_argument("--format", choices=("hex", "json", "listing"), default="hex", help="default: %(default)s")
    compiling.add_argument("-o", "--output", metavar="FILE", help="default: standard output")
    dis = _command(commands, "dis", _dis, "print the bytecode or another stage of the compiler")
    dis.add_argument("--stage", type=_stage, choices=_STAGES, default="words", help="default: %(default)s")
    run = _command(commands, "run", _run, "execute the initialization and events, then print variables")
    run.add_argument(
        "--raise",
        dest="raised",
        metavar="EVENT[=VALUES]",
        type=_raised,
        action="append",
        default=[],
        help="event to raise afterwards, with comma-separated values (may be repeated)",
    )
    run.add_argument("--show", metavar="VARIABLE", action="append", help="default: all variables of the program")
    run.add_argument("--trace", action="store_true", help="print address, line and stack before each instruction")
    limit_help = "maximum instructions per event, default: %(default)s"
    run.add_argument(
        "--limit", metavar="N", type=partial(_number, lowest=1, highest=10**12), default=1_000_000, help=limit_help
    )
    fmt = _command(commands, "fmt", check_and_format.format_files, "normalize indentation and spacing")
    result = fmt.add_mutually_exclusive_group()
    result.add_argument("--write", action="store_true", help="change the files")
    result.add_argument("--check", action="store_true", help="change nothing; exit code 1 if a file would change")
    result.add_argument("--diff", action="store_true", help="like --check, and print the changes")
    for command in (check, fmt):
        command.add_argument("files", metavar="FILE", nargs="+", help=".aesl file, plain program text, folder, or -")
    for command in (compiling, dis, run):
        command.add_argument("file", metavar="FILE", help=".aesl file, plain program text, or -")
    for command in (check, compiling, dis, run, fmt):
        command.add_argument("--lang", choices=sorted(LANGUAGES), help="language of messages, default: from the locale")
    for command in (check, compiling, dis, run):
        command.add_argument("--target", metavar="FILE", help="target description in JSON, default: Thymio II")
        command.add_argument("--node", metavar="NAME", help="node of the .aesl file, default: that of the target")
        command.add_argument(
            "--global",
            dest="events",
            metavar="NAME=WORDS",
            type=partial(_pair, lowest=0, highest=MAX_EVENT_WORDS),
            action="append",
            default=[],
            help="a global event (may be repeated)",
        )
        command.add_argument(
            "--constant",
            dest="constants",
            metavar="NAME=VALUE",
            type=partial(_pair, lowest=-0x8000, highest=0x7FFF),
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


def _stage(text: str) -> str:
    return {"optimised": "optimized"}.get(text, text)  # the former spelling is still accepted


def _number(text: str, lowest: int, highest: int) -> int:
    try:
        number = int(text)
    except ValueError:
        number = lowest - 1
    if not lowest <= number <= highest:
        raise argparse.ArgumentTypeError(f"found {text!r}, expected a number from {lowest} to {highest}")
    return number


def _pair(text: str, lowest: int, highest: int) -> tuple[str, int]:
    name, _, value = text.rpartition("=")
    if not is_name(name):
        raise argparse.ArgumentTypeError(f"found {text!r}, expected NAME=NUMBER")
    return name, _number(value, lowest, highest)


def _raised(text: str) -> tuple[str, list[int]]:
    name, _, values = text.partition("=")
    return name, [_number(value, -0x8000, 0x7FFF) for value in values.split(",")] if values else []
