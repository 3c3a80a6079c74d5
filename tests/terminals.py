"""Terminals that execute the commands of a page (tests/pages.py) as its readers would: shells, Ctrl-C, output."""

from __future__ import annotations

import contextlib
import importlib.util
import os
import re
import select
import shutil
import signal
import subprocess
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from tests import pages
from tests.pages import INTERRUPT, ROOT, Block, Command
from tests.patience import PATIENCE_S, PROGRAM_S, Deadline
from tests.processes import PYTHON, free_port, until, wait_until_asleep

HAS_ROS2 = importlib.util.find_spec("ros2cli") is not None or shutil.which("ros2") is not None
NO_ROS2 = "all but the commands `ros2`, which this machine does not have (docs/ros2-tools.md says how to get them)"

_PAGE_PORTS = {"--port": 8080, "--foxglove-port": 8765}
_AFTER_INTERRUPT = (0, 2, 128 + signal.SIGINT)
"""Exit codes of commands that end with Ctrl-C: of nodes that handle it, of `ros2`, of others."""
_ESCAPES = re.compile(r"\x1b\[[0-9;?]*[a-zA-Z]")
_PROMPT = re.compile(r"\x1e(\d+)\x1e")
_SET_UP = "stty -echo cols 200; PS1=; PS2=; PROMPT_COMMAND='printf \"\\x1e%s\\x1e\" $?'\n"
_NEEDS_ROS2 = re.compile(r"(^|[|;&(]\s*)(\w+=\S* )*ros2 ")
_LOOKS = re.compile(
    r"ros2 (topic (list|type|info|echo --once)|node (list|info)|param (get|list)|service (list|type)) ?"
)
"""Commands that only look, which a reader repeats: their first answer may be incomplete (docs/tutorials/index.md)."""
_ERASED = re.compile(r"[^\n]*\r\x1b\[K")
_SUITE = re.compile(r"thymio-sim($| --)")
_MARKED = re.compile(r"<!-- needs ros2 -->\s*\Z")


class Terminal:
    """A shell on a pseudo-terminal. Output is collected until the shell prompts again."""

    def __init__(self, folder: Path, environment: Mapping[str, str], shown_as: Mapping[str, str]) -> None:
        """Start it in a folder. `shown_as`: texts of its output, and what the page has in their places."""
        self._shown_as = shown_as
        self._master, slave = os.openpty()
        command = ["setsid", "--ctty", "bash", "--noprofile", "--norc", "--noediting", "-i"]
        with open(slave, "r+b", buffering=0) as end:
            self._shell = subprocess.Popen(command, stdin=end, stdout=end, stderr=end, cwd=folder, env=environment)
        self._raw = b""
        self._matched = 0
        self._running = "the shell"
        self._write(_SET_UP)
        self._wait(lambda: self.exit_code is not None)
        self._running = ""

    @property
    def printed(self) -> str:
        """The output of the last command so far, in whole lines unless it has ended, as a page would show it."""
        text = _ERASED.sub("", self._raw.decode(errors="replace").replace("\r\n", "\n"))
        ended = _PROMPT.search(text)
        text = _ESCAPES.sub("", text[: ended.start()] if ended else text[: text.rfind("\n") + 1])
        for actual, shown in self._shown_as.items():
            text = text.replace(actual, shown)
        return "".join(f"{line.rstrip()}\n" for line in text.splitlines())

    @property
    def exit_code(self) -> int | None:
        """The exit code of the last command; None while it runs."""
        ended = _PROMPT.search(self._raw.decode(errors="replace"))
        return int(ended[1]) if ended else None

    @property
    def is_busy(self) -> bool:
        """Whether a command runs."""
        return bool(self._running)

    def run(self, command: Command, *, stays: bool) -> None:
        """Type a command and wait for what it prints; also for its end, unless it `stays` until Ctrl-C."""
        if self.is_busy:
            self.finish()
        self._type(command.text)
        if stays:
            self.expect(command)
            return
        self._wait(lambda: self.exit_code is not None)
        deadline = Deadline(PROGRAM_S)
        while not self._is_as_promised(command) and _LOOKS.match(command.text) and not deadline.is_over:
            self._type(command.text)
            self._wait(lambda: self.exit_code is not None)
        self._running = ""
        assert re.fullmatch(pages.pattern(command.printed), self.printed), self._difference(command)
        assert self.exit_code == 0, f"line {command.line}: {command.text!r} ended with {self.exit_code}\n{self.printed}"

    def expect(self, command: Command) -> None:
        """Wait until the running command has printed these lines, after those that were waited for before."""
        assert self.is_busy, f"line {command.line}: nothing runs in terminal {command.terminal} that could print"
        expected = re.compile(pages.pattern(command.printed))

        def found() -> re.Match[str] | None:
            return expected.match(self.printed, self._matched)

        self._wait(lambda: found() or self.exit_code is not None, lambda: self._difference(command))
        match = found()
        assert match, f"{self._difference(command)}\nIt ended with {self.exit_code}."
        self._matched = match.end()

    def finish(self) -> None:
        """Wait until a command that printed its lines ends by itself."""
        self._wait(lambda: self.exit_code is not None)
        name, self._running = self._running, ""
        assert self.exit_code == 0, f"{name!r} ended with {self.exit_code}\n{self.printed}"

    def interrupt(self, command: Command) -> None:
        """Press Ctrl-C and wait for the end: the last lines are those of the page, and there is no traceback."""
        assert self.is_busy, f"line {command.line}: nothing runs in terminal {command.terminal} to press Ctrl-C for"
        assert self.exit_code is None, f"{self._running!r} ended with {self.exit_code} before Ctrl-C\n{self.printed}"
        wait_until_asleep(self._wait_for_program())
        self._write("\x03")
        self._wait(lambda: self.exit_code is not None)
        name, self._running = self._running, ""
        assert "Traceback" not in self.printed, f"{name!r} after Ctrl-C:\n{self.printed}"
        assert self.exit_code in _AFTER_INTERRUPT, f"{name!r} ended with {self.exit_code}\n{self.printed}"
        last = re.compile(pages.pattern(command.printed) + r"\Z")
        assert last.search(self.printed), self._difference(command)

    def close(self) -> None:
        """End the shell and what runs in it."""
        with contextlib.suppress(ProcessLookupError, OSError):
            os.killpg(os.tcgetpgrp(self._master), signal.SIGKILL)
        self._shell.kill()
        self._shell.wait()
        os.close(self._master)

    def _wait_for_program(self) -> int:
        """Wait until the shell has started what was typed, and would not get Ctrl-C itself; return its group.

        A program that ends by itself at once may have printed something, its prompt at least.
        """
        until(lambda: os.tcgetpgrp(self._master) != self._shell.pid or select.select([self._master], [], [], 0.0)[0])
        return os.tcgetpgrp(self._master)

    def _type(self, text: str) -> None:
        self._raw, self._matched, self._running = b"", 0, text
        self._write(f"{text}\n")

    def _is_as_promised(self, command: Command) -> bool:
        return self.exit_code == 0 and re.fullmatch(pages.pattern(command.printed), self.printed) is not None

    def _difference(self, command: Command) -> str:
        expected = "\n".join(command.printed)
        return f"line {command.line}: {self._running or command.text!r}\nexpected\n{expected}\nfound\n{self.printed}"

    def _write(self, text: str) -> None:
        os.write(self._master, text.encode())

    def _wait(self, condition: Callable[[], object], describe: Callable[[], str] | None = None) -> None:
        """Read until the condition is true."""
        deadline = Deadline(PROGRAM_S)
        while not condition():
            if not select.select([self._master], [], [], deadline.left_s)[0]:
                found = describe() if describe else f"{self._running!r} has not ended\n{self.printed}"
                raise AssertionError(f"after {PROGRAM_S:g} s: {found}")
            self._raw += os.read(self._master, 65536)


class Reader:
    """A reader of a page, who saves its files and types its commands, in one folder and any number of terminals."""

    def __init__(self, folder: Path, domain: int) -> None:
        """Prepare an empty folder; ROS uses this domain, and the suite free ports instead of its usual ones."""
        self._folder = folder / "reader"
        self._folder.mkdir()
        self._ports = {option: free_port() for option in _PAGE_PORTS}
        self._commands = folder / "bin"
        self._write_commands()
        paths = [str(ROOT), os.environ.get("PYTHONPATH", "")]
        self._environment = os.environ | {
            "PATH": f"{self._commands}:{os.environ['PATH']}",
            "PYTHONPATH": ":".join(path for path in paths if path),
            "ROS_DOMAIN_ID": str(domain),
            "TERM": "dumb",
            "THYMIO_SIM_CONNECT": f"ws://127.0.0.1:{self._ports['--foxglove-port']}",
        }
        self._terminals: dict[int, Terminal] = {}
        self._left_out: set[int] = set()
        """Terminals whose last command was left out."""
        self.has_skipped = False
        self._has_used_ros2 = False

    def follow(self, text: str) -> None:
        """Save and execute everything in order, then press Ctrl-C in each terminal, the last one first."""
        found = pages.all_blocks(text)
        later = [(command.terminal, command) for block in found for command in _commands_of(block)]
        for block in found:
            if block.file_name:
                path = self._folder / block.file_name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(block.text, encoding="utf-8")
            for command in _commands_of(block):
                later.pop(0)
                following = next((other for number, other in later if number == command.terminal), None)
                if not self._leaves_out(command, block):
                    self._execute(command, following)
        for number in sorted(self._terminals, reverse=True):
            terminal = self._terminals[number]
            if terminal.is_busy and terminal.exit_code is not None:
                terminal.finish()
            elif terminal.is_busy:
                terminal.interrupt(Command(number, INTERRUPT, (pages.GAP,), 0))

    def close(self) -> None:
        """End everything, also the daemon of `ros2`."""
        for terminal in self._terminals.values():
            terminal.close()
        if self._has_used_ros2:
            stop = [str(self._commands / "ros2"), "daemon", "stop"]
            subprocess.run(stop, env=self._environment, capture_output=True, timeout=PATIENCE_S, check=False)

    def _leaves_out(self, command: Command, block: Block) -> bool:
        """Whether a command is not executed because it needs `ros2`, or continues one that was not executed."""
        if HAS_ROS2:
            return False
        if command.text in ("", INTERRUPT):
            is_left_out = command.terminal in self._left_out or (not command.text and _is_marked(block))
        else:
            is_left_out = bool(_NEEDS_ROS2.search(command.text)) or _is_marked(block)
            (self._left_out.add if is_left_out else self._left_out.discard)(command.terminal)
        self.has_skipped |= is_left_out
        return is_left_out

    def _execute(self, command: Command, following: Command | None) -> None:
        terminal = self._terminals.get(command.terminal)
        self._has_used_ros2 |= bool(_NEEDS_ROS2.search(command.text))
        if terminal is None:
            shown_as = {str(self._ports[option]): str(port) for option, port in _PAGE_PORTS.items()}
            shown_as[f"ROS_DOMAIN_ID {self._environment['ROS_DOMAIN_ID']},"] = "ROS_DOMAIN_ID 0,"
            terminal = Terminal(self._folder, self._environment, shown_as)
            self._terminals[command.terminal] = terminal
        if command.text == INTERRUPT:
            terminal.interrupt(command)
        elif command.text:
            terminal.run(command, stays=_stays(command, following))
        else:
            terminal.expect(command)

    def _write_commands(self) -> None:
        """The commands of an installation, for this source tree: the suite on free ports and without other servers."""
        self._commands.mkdir()
        ports = " ".join(f"{option} {port}" for option, port in self._ports.items())
        scripts = {
            "python": 'exec "$PYTHON" "$@"',
            "pytest": 'exec "$PYTHON" -m pytest -p thymio_sim_ros.pytest_plugin -p no:cacheprovider "$@"',
            "aseba": 'exec "$PYTHON" -m aseba_vm "$@"',
            "thymio-sim": 'case "${1:---}" in\n'
            f'--*) exec "$PYTHON" -m thymio_sim_ros {ports} --no-aseba --no-tdm "$@" ;;\n'
            '*) exec "$PYTHON" -m thymio_sim_ros "$@" ;;\nesac',
        }
        if importlib.util.find_spec("ros2cli"):
            scripts["ros2"] = 'exec "$PYTHON" -c "import sys; from ros2cli.cli import main; sys.exit(main())" "$@"'
        elif installed := shutil.which("ros2"):
            scripts["ros2"] = f'exec {installed} "$@"'
        for name, script in scripts.items():
            path = self._commands / name
            path.write_text(f"#!/bin/sh\nPYTHON={PYTHON}\n{script}\n")
            path.chmod(0o755)


@contextlib.contextmanager
def reader(folder: Path, domain: int) -> Iterator[Reader]:
    """A reader whose programs end with the context."""
    made = Reader(folder, domain)
    try:
        yield made
    finally:
        made.close()


def _is_marked(block: Block) -> bool:
    """Whether the comment `needs ros2` before a block says that its commands and output depend on those of `ros2`."""
    return bool(_MARKED.search(block.before))


def _commands_of(block: Block) -> list[Command]:
    return pages.commands(block) if block.language == "console" else []


def _stays(command: Command, following: Command | None) -> bool:
    """Whether only its lines are waited for, not its end, as what follows in its terminal shows.

    The suite, and the last command of any terminal but the first, may run until the end of the page.
    """
    if following is None:
        return command.terminal > 1 or bool(_SUITE.match(command.text))
    return following.text in ("", INTERRUPT)
