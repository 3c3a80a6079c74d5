"""The commands `check` and `fmt`: files and folders one by one, with one summary and one exit code."""

from __future__ import annotations

import argparse
import difflib
import json
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from aseba_vm import aesl
from aseba_vm.aesl.text_decoding import TextFile
from aseba_vm.cli.inputs import Source, network_of, read_text, sources_of
from aseba_vm.cli.output import print_bytes, write_file
from aseba_vm.cli.report import (
    ERROR,
    NOTE,
    WARNING,
    Finding,
    files_in,
    finding_of_compile_error,
    finding_of_text_error,
    is_colored,
)
from aseba_vm.errors import AeslError, CompileError, TextError
from aseba_vm.frontend.formatter import format_program
from aseba_vm.frontend.pipeline import assemble
from aseba_vm.languages import texts
from aseba_vm.messages import format_message
from aseba_vm.target import TargetDescription
from aseba_vm.targets import THYMIO_II

CLEAN = 0
FOUND = 1
UNREADABLE = 2


@dataclass(slots=True)
class _Run:
    """State of one command line: options, exit code and findings so far."""

    options: argparse.Namespace
    messages: Mapping[str, str]
    code: int = CLEAN
    files: int = 0
    findings: list[Finding] = field(default_factory=list)

    @property
    def is_json(self) -> bool:
        return getattr(self.options, "format", "text") == "json"

    def report(self, finding: Finding, text: str, code: int = CLEAN) -> None:
        """Record a finding, and print it unless all are printed as JSON at the end."""
        self.code = max(self.code, code)
        self.findings.append(finding)
        if not self.is_json:
            label = format_message("label-hint", (), self.messages)
            print(finding.text(text, label=label, is_colored=is_colored()), file=sys.stderr)

    def fail(self, error: OSError) -> None:
        """Report a file that cannot be read or written."""
        self.code = UNREADABLE
        self.findings.append(Finding(str(error.filename), None, None, ERROR, "file", str(error.strerror)))
        if not self.is_json:
            print(f"aseba: {error.filename}: {error.strerror}", file=sys.stderr)

    def for_each_file(self, handle: Callable[[str, TextFile], None]) -> None:
        """Process every file of the command line; an error in one does not stop the others."""
        files: dict[str, None] = {}
        for name in self.options.files:
            try:
                files |= dict.fromkeys(files_in(name))
            except OSError as error:
                self.fail(error)
        for file in files:
            self.handle(file, handle)

    def handle(self, name: str, handle: Callable[[str, TextFile], None]) -> None:
        self.files += 1
        try:
            text = read_text(name)
        except TextError as error:
            return self.report(finding_of_text_error(name, error, self.messages), "", UNREADABLE)
        except OSError as error:
            return self.fail(error)
        try:
            handle(name, text)
        except AeslError as error:
            code = UNREADABLE if error.kind == "aesl-other-robot" else FOUND
            self.report(finding_of_text_error(name, error, self.messages), text.text, code)
        return None

    def summarize(self, kind: str, *numbers: int) -> None:
        """Print a summary if there are several files."""
        if self.files > 1:
            print(format_message(kind, (self.files, *numbers), self.messages), file=sys.stderr)

    def count(self, severity: str) -> int:
        """The number of files with findings of a severity."""
        return len({finding.file for finding in self.findings if finding.severity == severity})


# -- check -------------------------------------------------------------------------------------------------------------


def check(options: argparse.Namespace, target: TargetDescription) -> int:
    """Report the first error of each program, or its warnings, and return the exit code."""
    run = _Run(options, texts("compiler", options.language))
    run.for_each_file(lambda name, file: _check_file(run, name, file.text, target))
    if run.is_json:
        print(json.dumps([finding.data() for finding in run.findings], indent=1, ensure_ascii=False))
    run.summarize("check-summary", run.count(ERROR), run.count(WARNING))
    return run.code


def _check_file(run: _Run, name: str, text: str, target: TargetDescription) -> None:
    options = run.options
    network = network_of(text, target.name)
    sources = sources_of(network, name, target.name, options.node, options.events, options.constants)
    for source in sources:
        _check_source(run, source, text, target, is_optional=any(not candidate.is_guessed for candidate in sources))


def _check_source(run: _Run, source: Source, text: str, target: TargetDescription, *, is_optional: bool) -> None:
    def note(kind: str, argument: str) -> None:
        row, col = source.place(0)
        sentence = format_message(kind, (source.node.name, argument), run.messages)
        run.report(Finding(source.name, row + 1, col + 1, NOTE, kind, sentence), text)

    try:
        program = assemble(source.compiled(target), target)
    except CompileError as error:
        finding = finding_of_compile_error(source, error, run.messages)
        if source.is_guessed and is_optional:
            return note("note-left-out-node", finding.located)
        if source.is_guessed:
            note("note-checked-as", target.name)
        return run.report(finding, text, FOUND)
    if source.is_guessed:
        note("note-checked-as", target.name)
    for warning in program.warnings:
        row, col = source.place(warning.pos.offset)
        sentence = format_message(warning.kind, warning.arguments, run.messages)
        run.report(Finding(source.name, row + 1, col + 1, WARNING, warning.kind, sentence), text)
    return None


# -- fmt ---------------------------------------------------------------------------------------------------------------


def format_files(options: argparse.Namespace) -> int:
    """Format programs and return the exit code."""
    run = _Run(options, texts("compiler", options.language))
    changed: list[str] = []
    run.for_each_file(lambda name, file: _format_file(run, name, file, changed))
    run.summarize("fmt-summary", len(changed), run.count(ERROR))
    return run.code


def _format_file(run: _Run, name: str, file: TextFile, changed: list[str]) -> None:
    options = run.options
    result = _formatted(run, name, file.text)
    if result is None:
        return
    is_different = result != file.text
    if is_different:
        changed.append(name)
    if options.diff:
        before, after = (text.splitlines(keepends=True) for text in (file.text, result))
        for line in difflib.unified_diff(before, after, name, name):
            sys.stdout.write(line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n")
    if options.check or options.diff:
        if is_different:
            run.code = max(run.code, FOUND)
            if not options.diff:
                print(f"{name}: {format_message('fmt-different', (), run.messages)}", file=sys.stderr)
    elif options.write and name != "-":
        if is_different:
            try:
                write_file(name, file.encoded(result))
            except OSError as error:
                run.fail(error)
    else:
        print_bytes(file.encoded(result))


def _formatted(run: _Run, name: str, text: str) -> str | None:
    """The text with formatted programs; None if one of them has an error."""
    network = network_of(text, THYMIO_II.name)
    nodes = []
    for node in network.nodes:
        try:
            nodes.append(replace(node, code=format_program(node.code)))
        except CompileError as error:
            run.report(finding_of_compile_error(Source(name, node), error, run.messages), text, FOUND)
            return None
    if network.pieces:
        return aesl.dumps(replace(network, nodes=tuple(nodes)))
    return nodes[0].code.replace("\n", "\r\n" if "\r\n" in text else "\n")
