"""tdmclient, the Python client (PyPI), against our device manager: its commands, and its functions for notebooks."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.patience import PATIENCE_S, until

tdmclient = pytest.importorskip("tdmclient", reason="needs tdmclient (pip install tdmclient)")

from aseba_vm import targets
from tests.network.tdm.machine_node import MachineNode
from tests.network.tdm.served import Served, served

pytestmark = pytest.mark.process

TIMER = targets.THYMIO_II.local_event_number("timer0")


@pytest.fixture
def two() -> Iterator[Served]:
    """A device manager with two nodes."""
    with served(MachineNode(), MachineNode()) as found:
        yield found


class Command:
    """A command of tdmclient as a process, which ends with its context."""

    def __init__(self, found: Served, tool: str, *arguments: str) -> None:
        command = [sys.executable, "-u", "-m", "tdmclient", tool, f"--tdmport={found.tcp_port}", *arguments]
        self._popen = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def __enter__(self) -> Command:
        """The command itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Kill it: after an interrupt at an unlucky moment, its receiving thread reads a closed socket without end."""
        self._popen.kill()
        self._popen.communicate()

    def read_until(self, text: str) -> str:
        """Read lines up to one that contains a text."""
        assert self._popen.stdout is not None
        lines = ""
        for line in self._popen.stdout:
            lines += line
            if text in line:
                return lines
        raise AssertionError(f"ended without {text!r}: {lines}")

    def finish(self) -> str:
        """Wait for the end with exit code 0, and return the rest of the output."""
        output, _ = self._popen.communicate(timeout=PATIENCE_S)
        assert self._popen.returncode == 0, output
        return output


def finished(found: Served, tool: str, *arguments: str) -> str:
    """The output of a command that ends by itself."""
    with Command(found, tool, *arguments) as command:
        return command.finish()


def test_list_shows_the_robots_and_ends(two: Served) -> None:
    output = finished(two, "list")
    shown = [line for line in output.splitlines() if line.startswith(("name", "type", "status", "cap"))]
    robot = ["type:       2 (Simulated Thymio II)", "name:       {}", "status:     2 (available)", "cap:        3"]
    assert shown == [line.format(f"thymio_{place}") for place in (0, 1) for line in robot]


def test_run_translates_python_prints_and_is_stopped(two: Served, tmp_path: Path) -> None:
    script = tmp_path / "drive.py"
    script.write_text(
        "motor_left_target = 200\n"
        "n = 40\n"
        "@onevent\n"
        "def timer0():\n"
        "    global n\n"
        "    n += 2\n"
        '    print("tick", n, motor_left_target)\n'
    )
    node = two.networks[1].node
    with Command(two, "run", "--robotname=thymio_1", str(script)) as command:
        until(lambda: node.value("motor.left.target") == (200,))
        two.start_event(1, TIMER)
        assert command.read_until("tick") == "tick 42 200\n"
    finished(two, "run", "--stop", "--robotname=thymio_1")
    assert node.value("motor.left.target") == (0,)


def test_run_registers_events_that_sendevent_sends(two: Served, tmp_path: Path) -> None:
    script = tmp_path / "go.aseba"
    script.write_text("onevent go\nmotor.left.target = event.args[0] - event.args[1]\n")
    finished(two, "run", "--event=go[2]", "--nosleep", str(script))
    finished(two, "sendevent", "--event=go", "--data=[300,-77]")
    assert two.networks[0].node.value("motor.left.target") == (377,)


def test_an_error_of_a_program_is_shown(two: Served, tmp_path: Path) -> None:
    script = tmp_path / "wrong.aseba"
    script.write_text("var a\nmotor.lefft.target = 1\n")
    with Command(two, "run", str(script)) as command:
        assert "motor.lefft.target" in command.read_until("error")


def test_watch_shows_variables_and_states(two: Served) -> None:
    with Command(two, "watch", "--robotname=thymio_1", "--variables", "--vm-state") as command:
        shown = command.read_until("timer.period")
    assert "prox.horizontal [0, 0, 0, 0, 0, 0, 0]" in shown
    assert "execution state of node" in shown


NOTEBOOK = """
import sys
from tdmclient import ClientAsync, aw

client = ClientAsync(tdm_port=int(sys.argv[1]))
node = aw(client.wait_for_node(node_name="thymio_1"))
aw(node.lock())
aw(node.wait_for_variables())
node.v.motor.left.target = 150
node["acc"] = [1, 2, 3]
node.flush()
print(aw(node.compile("nonsense")))
print(aw(node.register_events([("seen", 2), ("go", 0)])))
print(aw(node.compile("onevent go\\nemit seen [7, motor.left.target]\\n")), aw(node.run()))
aw(node.watch(events=True))
heard = []
client.add_event_received_listener(lambda node, name, data: heard.append((name, data)))
print(aw(node.set_variables({"motor.left.target": [-20]})), aw(node.set_variables({"motor.left.target": [1, 2]})))
print(aw(node.send_events({"go": []})))
aw(client.sleep(30, wake=lambda: bool(heard)))
print(heard)
aw(node.unlock())
client.disconnect()
"""


def test_a_script_like_a_notebook_drives_a_robot(two: Served) -> None:
    done = subprocess.run(
        [sys.executable, "-c", NOTEBOOK, str(two.tcp_port)], capture_output=True, text=True, timeout=PATIENCE_S
    )
    assert done.stdout.splitlines() == [
        """{'error_msg': "no variable is called 'nonsense'", 'error_line': 0, 'error_col': 0}""",
        "None",
        "None None",
        "None {'error_code': 4}",
        "None",
        "[('seen', [7, -20])]",
    ], done.stderr
