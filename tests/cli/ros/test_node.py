"""The command `thymio-sim node` without a server."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.patience import PATIENCE_S
from tests.portable_ros.rosbridge.socket_server import SocketServer
from tests.processes import free_port
from thymio_sim_ros.cli import main
from thymio_sim_ros.cli.ros import node


@pytest.mark.parametrize(
    ("words", "own", "arguments"),
    [
        ("my.py", "my.py", ""),
        ("my.py a -m --b 1 --connect ws://x --c", "my.py --connect ws://x", "a -m --b 1 --c"),
        ("--token=t --connect ws://x my.py -h", "--token=t --connect ws://x my.py", "-h"),
        ("-m tool --connect ws://x -n 1 pass", "-m tool --connect ws://x", "-n 1 pass"),
        ("my.py --ros-args --connect x -p a:=1", "my.py", "--ros-args --connect x -p a:=1"),
        ("-h", "-h", ""),
    ],
)
def test_words_belong_to_the_command_or_to_the_program(words: str, own: str, arguments: str) -> None:
    assert node._split(words.split()) == (own.split(), arguments.split())


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        ("node", "thymio-sim: node: found no program, expected FILE or -m MODULE"),
        ("node none.py", "thymio-sim: none.py: found no such file, expected a program in Python"),
    ],
)
def test_a_missing_program_is_one_line(words: str, reason: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main.main(words.split()) == 2
    assert capsys.readouterr().err == f"{reason}\n"


@pytest.mark.parametrize("url", ["http://x", "ws://", "ws://:1", "x://y"])
def test_a_wrong_address_is_refused_with_what_is_expected(url: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main.main(["node", "my.py", "--connect", url])
    assert end.value.code == 2
    assert f"found {url!r}, expected an address such as ws://localhost:8765" in capsys.readouterr().err


@pytest.mark.process
@pytest.mark.parametrize(
    ("program", "code", "printed"),
    [
        ("import sys; sys.exit(3)", 3, ""),
        (
            "import threading, time\nend = threading.Event()\n"
            "threading.Thread(target=lambda: (end.wait(), print('end'))).start()\nend.set()",
            0,
            "end\n",
        ),
        ("from concurrent.futures import ThreadPoolExecutor\nThreadPoolExecutor().submit(print, 'pool')", 0, "pool\n"),
    ],
)
def test_a_program_ends_as_with_python(program: str, code: int, printed: str, tmp_path: Path) -> None:
    done = _run(tmp_path, program)
    assert (done.returncode, done.stdout, done.stderr) == (code, printed, "")


@pytest.mark.process
def test_an_exception_is_shown_from_the_program_on(tmp_path: Path) -> None:
    program = "from geometry_msgs.msg import Twist\ndef f():\n    Twist().linear.x = 1\nf()\n"
    done = _run(tmp_path, program)
    assert done.returncode == 1
    lines = done.stderr.splitlines()
    assert lines[0] == "Traceback (most recent call last):"
    assert lines[1].endswith('program.py", line 4, in <module>')
    assert lines[-1] == "AssertionError: The 'x' field must be of type 'float'"


@pytest.mark.process
def test_a_server_that_rejects_the_token_is_one_line(tmp_path: Path) -> None:
    done = _run(tmp_path, "print('runs')", "the token is wrong")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("thymio-sim: node: ws://127.0.0.1:")
    assert done.stderr.endswith(": the token is wrong\n")


def _run(folder: Path, program: str, rejection: str = "") -> subprocess.CompletedProcess[str]:
    file = folder / "program.py"
    file.write_text(program, encoding="utf-8")
    port = free_port()
    words = ("-m", "thymio_sim_ros", "node", str(file), "--connect", f"ws://127.0.0.1:{port}", "--token", "secret")
    with SocketServer(port, rejection):
        return subprocess.run([sys.executable, *words], capture_output=True, text=True, check=False, timeout=PATIENCE_S)
