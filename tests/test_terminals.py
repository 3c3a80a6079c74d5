"""Terminals for pages: what a page promises holds, or the test of the page says what does not."""

from __future__ import annotations

import os
import re
import shutil
import signal
from collections.abc import Callable
from pathlib import Path

import pytest

from tests import terminals
from tests.pages import INTERRUPT, Command

pytestmark = [
    pytest.mark.process,
    pytest.mark.skipif(shutil.which("setsid") is None, reason="the program setsid is not installed"),
]

COUNTER = """\
Save it as `count.py`:

```python
import itertools
import time

try:
    for number in itertools.count():
        print(f"number {number}")
        time.sleep(0.01)
except KeyboardInterrupt:
    print("the end")
```
"""


@pytest.fixture
def follow(tmp_path: Path) -> Callable[[str], terminals.Reader]:
    """Follow a page."""

    def make(text: str) -> terminals.Reader:
        with terminals.reader(tmp_path, domain=0) as reader:
            reader.follow(text)
        return reader

    return make


def console(*lines: str) -> str:
    """A block of commands."""
    return "\n```console\n" + "\n".join(lines) + "\n```\n"


def test_a_page_that_keeps_its_promises(follow: Callable[[str], terminals.Reader]) -> None:
    reader = follow(
        COUNTER
        + console("$ export GREETING=hello", "$ cat count.py | wc -l", "9", "$ ls", "count.py")
        + console("# terminal 2", "$ echo $GREETING", "", "$ python count.py", "number 0", "...", "number 3")
        + console('$ echo "$GREETING" \\', "> again", "hello again")
        + console("# terminal 2", "...", "number 5")
        + console("# terminal 2", "$ ^C", "the end", "$ echo 'now free'", "now free", "$ sleep 1000")
    )
    assert not reader.has_skipped


def test_ctrl_c_waits_until_the_shell_has_started_the_program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    in_front: list[int] = []

    def group(terminal: int) -> int:
        """The group in front; the shell, which has not read its command, goes on only then."""
        in_front.append(tcgetpgrp(terminal))
        os.kill(in_front[0], signal.SIGCONT)
        return in_front[-1]

    tcgetpgrp = os.tcgetpgrp
    with terminals.reader(tmp_path, domain=0) as reader:
        reader.follow(console("$ echo a", "a"))
        terminal = reader._terminals[1]
        monkeypatch.setattr(os, "tcgetpgrp", group)
        os.kill(terminal._shell.pid, signal.SIGSTOP)
        terminal.run(Command(1, "sleep 1000", (), 0), stays=True)
        terminal.interrupt(Command(1, INTERRUPT, (), 0))
        assert terminal.exit_code == 128 + signal.SIGINT
        assert in_front[0] == terminal._shell.pid != in_front[-1]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (console("$ echo a", "b"), r"line 3: 'echo a'\nexpected\nb\nfound\na"),
        (console("$ echo a"), r"line 3: 'echo a'\nexpected\n\nfound\na"),
        (console("$ sh -c 'exit 3'"), r"line 3: \"sh -c 'exit 3'\" ended with 3"),
        (console("# terminal 2", "$ echo a", "b", "$ ^C"), "It ended with 0"),
        (console("# terminal 2", "$ sh -c 'echo a; exit 3'", "a") + console("# terminal 2", "b"), "It ended with 3"),
        (console("# terminal 2", "a"), "nothing runs in terminal 2 that could print"),
        (console("$ ^C"), "nothing runs in terminal 1 to press Ctrl-C for"),
        (console("# terminal 2", "$ python -c 'import time; print(1); time.sleep(1000)'", "1", "$ ^C"), "Traceback"),
        (COUNTER + console("$ python count.py", "number 0", "$ ^C", "other"), "expected\nother\nfound"),
    ],
)
def test_a_promise_that_is_broken_is_an_error(follow: Callable[[str], terminals.Reader], text: str, says: str) -> None:
    with pytest.raises(AssertionError, match=says):
        follow(text)


def test_a_command_that_does_not_end_or_print_is_an_error(
    follow: Callable[[str], terminals.Reader], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(terminals, "PROGRAM_S", 1.0)
    with pytest.raises(AssertionError, match="after 1 s: 'sleep 1000' has not ended"):
        follow(console("$ sleep 1000"))


def test_what_a_program_erases_is_not_seen(follow: Callable[[str], terminals.Reader]) -> None:
    follow("```console\n$ printf '1 of 2\\r\\033[K2 of 2\\r\\033[Kdone\\n'\ndone\n```\n")


def test_a_look_is_repeated_until_it_shows_what_is_promised(
    follow: Callable[[str], terminals.Reader], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(terminals, "_LOOKS", re.compile("look"))
    follow("```console\n$ look() { echo >>seen; wc -l <seen; }\n$ look\n3\n```\n")


def test_without_ros2_blocks_that_need_it_are_left_out(
    follow: Callable[[str], terminals.Reader], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(terminals, "HAS_ROS2", False)
    reader = follow(
        COUNTER
        + console("# terminal 2", "$ export GREETING=hello", "$ ros2 topic echo /odom", "never printed")
        + console("# terminal 2", "also never printed")
        + console("# terminal 2", "$ ^C", "$ echo $GREETING", "hello")
        + "\n<!-- needs ros2 -->\n"
        + console("$ echo a", "not a")
        + console("$ echo b", "b")
        + console("# terminal 3", "$ python count.py", "number 0", "...", "number 2")
        + "\n<!-- needs ros2 -->\n"
        + console("# terminal 3", "number -1")
        + console("# terminal 3", "$ ^C", "the end")
    )
    assert reader.has_skipped
