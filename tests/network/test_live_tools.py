"""Debian's Aseba tools, thymiodirect and Studio against a running suite (docs/spec/aseba-protocol.md section 4).

One suite with one robot serves all of them, in the order of the tests; each skips where its tool is absent.
"""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
import urllib.error
import urllib.request
from importlib.util import find_spec
from pathlib import Path

import pytest

from aseba_vm.protocol import (
    ExecutionStateChanged,
    GetExecutionState,
    GetVariables,
    ListNodes,
    NodePresent,
    UserMessage,
    Variables,
)
from tests.network import virtual_display
from tests.network.aseba_client import AsebaClient
from tests.patience import PATIENCE_S, until
from tests.processes import free_port, x_display
from thymio_sim_ros.device.layout import target

pytest.importorskip("rclpy", reason="needs ROS 2")

from thymio_sim_ros.testing.ros.domain import reserved

LOCALE = Path("/usr/lib/locale/C.utf8")
PROGRAM = """<network><event size="1" name="hello"/><event size="1" name="answer"/>
<node nodeId="1" name="thymio-II">var n = 0
timer.period[0] = 100
onevent timer0
n += 1
emit hello n
onevent hello
emit answer event.args[0] * 2
</node></network>"""
PROGRAM_VARIABLE = target().variables_end
HELLO, ANSWER = 0, 1

pytestmark = pytest.mark.process


def needs(tool):
    return pytest.mark.skipif(shutil.which(tool) is None, reason=f"{tool} (Debian's package aseba) is not installed")


def wait_for(condition, what):
    return until(condition, lambda: what, every_s=0.05)


@pytest.fixture(scope="module")
def port(tmp_path_factory):
    """The Aseba port of a suite with one robot that has no program."""
    number, log = free_port(), tmp_path_factory.mktemp("suite") / "log"
    command = [sys.executable, "-m", "thymio_sim_ros", "--headless", "--program", "none", "--aseba-port", str(number)]
    with reserved(), log.open("w") as output:
        suite = subprocess.Popen(command, stdout=output, stderr=subprocess.STDOUT)
        try:
            wait_for(lambda: "Stop  " in log.read_text() or suite.poll() is not None, "the suite has started")
            assert suite.poll() is None, log.read_text()
            yield number
        finally:
            suite.send_signal(signal.SIGINT)
            suite.wait(PATIENCE_S)
    assert "internal error" not in log.read_text()


@pytest.fixture
def client(port):
    made = AsebaClient(port)
    yield made
    made.close()


@pytest.fixture
def start(tmp_path):
    """Start a tool that runs until the end of the test; its output goes to a file, whose path is returned."""
    running = []

    def run(*command, **environment):
        output = tmp_path / f"{command[0]}.log"
        with output.open("w") as file:
            running.append(
                subprocess.Popen(command, stdout=file, stderr=subprocess.STDOUT, env=os.environ | environment)
            )
        return output

    yield run
    for process in running:
        process.kill()
        process.wait()


@pytest.fixture
def program(tmp_path):
    path = tmp_path / "prog.aesl"
    path.write_text(PROGRAM)
    return path


@pytest.fixture
def locales(tmp_path):
    """A folder with the locale en_US.UTF-8, which the loader requires; C.UTF-8 has the same characters."""
    if not LOCALE.is_dir():
        pytest.skip("the loader needs a locale with UTF-8")
    (tmp_path / "en_US.UTF-8").symlink_to(LOCALE)
    return str(tmp_path)


def get(url):
    """The JSON of a REST interface; None while it does not answer."""
    try:
        with urllib.request.urlopen(url, timeout=PATIENCE_S) as answer:
            return json.loads(answer.read() or b"null")
    except (OSError, urllib.error.URLError):
        return None


@needs("asebacmd")
def test_asebacmd(port):
    for words in (["listnodes"], ["getnodedescr", "1"], ["usermsg", "0", "1", "2"]):
        done = subprocess.run(["asebacmd", "-t", f"tcp:127.0.0.1;{port}", *words], timeout=PATIENCE_S, check=False)
        assert done.returncode == 0


@needs("asebamassloader")
def test_asebamassloader_and_asebadump(port, client, start, program, locales):
    if shutil.which("stdbuf") is None:
        pytest.skip("stdbuf is not installed")
    dump = start("stdbuf", "-o0", "asebadump", f"tcp:127.0.0.1;{port}", LOCPATH=locales)
    wait_for(lambda: "connection created" in dump.read_text(), "asebadump is connected")
    command = ["asebamassloader", "--once", str(program), f"tcp:127.0.0.1;{port}"]
    done = subprocess.run(command, env=os.environ | {"LOCPATH": locales}, timeout=PATIENCE_S, check=False)
    assert done.returncode == 0
    first, second = (client.wait_for(UserMessage) for _ in range(2))
    assert (first.number, second.words[0]) == (HELLO, first.words[0] + 1)
    client.send(UserMessage(0, HELLO, (21,)))
    while (message := client.wait_for(UserMessage)).number != ANSWER:
        pass
    assert message.words == (42,)
    wait_for(lambda: "user message of size 1 :   42" in dump.read_text(), "asebadump prints the answer")


@needs("asebahttp")
def test_asebahttp(port, start, program, locales):
    http = free_port()
    start(
        "asebahttp", "-p", str(http), "-s", str(free_port()), "--aesl", str(program), f"tcp:127.0.0.1;{port}",
        LOCPATH=locales,
    )  # fmt: skip
    nodes = wait_for(lambda: get(f"http://127.0.0.1:{http}/nodes"), "asebahttp lists the node")
    assert [(node["node"], node["name"]) for node in nodes] == [(1, "thymio-II")]
    wait_for(lambda: (get(f"http://127.0.0.1:{http}/nodes/thymio-II/n") or [0])[0] > 0, "the program runs")


@pytest.mark.slow
@needs("asebahttp2")
def test_asebahttp2(port, start):
    http = free_port()
    start("asebahttp2", "-p", str(http), f"tcp:127.0.0.1;{port}")
    nodes = wait_for(lambda: get(f"http://127.0.0.1:{http}/nodes"), "asebahttp2 lists the node")
    assert [(node["node"], node["name"]) for node in nodes] == [(1, "thymio-II")]
    assert len(get(f"http://127.0.0.1:{http}/nodes/1/prox.horizontal")) == 7


@pytest.mark.slow
@needs("asebaswitch")
def test_asebaswitch(port, start):
    number = free_port()
    switch = start("asebaswitch", "-p", str(number), f"tcp:127.0.0.1;{port}")

    def connect():
        try:
            return AsebaClient(number)
        except OSError:
            return None

    clients = [wait_for(connect, f"the switch listens: {switch.read_text()}") for _ in range(2)]
    for one in clients:
        assert one.ask(ListNodes(0, 5), NodePresent) == NodePresent(1, 5)
        one.close()


@pytest.mark.skipif(find_spec("thymiodirect") is None, reason="thymiodirect is not installed")
def test_thymiodirect(port):
    program = f"""
import time
from thymiodirect import Thymio
thymio = Thymio(use_tcp=True, host="127.0.0.1", tcp_port={port})
thymio.connect()
robot = thymio[thymio.first_node()]
while robot["_fwversion"] != [14, 1]:
    time.sleep(0.05)
robot["motor.left.target"] = 120
while robot["motor.left.speed"] < 100:
    time.sleep(0.05)
robot["motor.left.target"] = 0
print(robot["_fwversion"], flush=True)
import os
os._exit(0)
"""
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=PATIENCE_S, check=False
    )
    assert done.stdout == "[14, 1]\n", done.stderr


LOAD, RUN, EDITOR = (74, 95), (206, 95), (550, 300)
"""Places in the window of Studio 1.6 on a display of 1280 x 900: buttons Load and Run (which becomes Pause), text."""
CLICKS = 12
"""Attempts to load and run a program until it is typed again."""


@pytest.mark.slow
@needs("asebastudio")
@pytest.mark.skipif(shutil.which("Xvfb") is None, reason="Xvfb is not installed")
@pytest.mark.skipif(not virtual_display.is_available(), reason="libX11 or libXtst is not installed")
def test_aseba_studio(port, client, start, locales, tmp_path):
    """Studio shows variables, loads a typed program, runs and pauses it."""
    with x_display() as name:
        home = str(tmp_path)
        start("asebastudio", f"tcp:127.0.0.1;{port}", DISPLAY=name, LOCPATH=locales, HOME=home, XDG_RUNTIME_DIR=home)
        display = virtual_display.VirtualDisplay(name)

        def value():
            return client.ask(GetVariables(0, 1, PROGRAM_VARIABLE, 1), Variables).values[0]

        def is_loaded():
            # Nothing outside shows whether the window is ready, the text compiled (until then Load has no effect), and
            # the program loaded (until then Run has none).
            display.click(*EDITOR)
            display.select_all()
            display.type("var m = 77\n")
            for button in (LOAD, RUN) * CLICKS:
                time.sleep(0.2)
                display.click(*button)
                if value() == 77:
                    return True
            return False

        wait_for(is_loaded, "Studio has loaded and started a program")

        def is_paused():
            for button in (LOAD, RUN, RUN):  # Run becomes Pause
                display.click(*button)
                time.sleep(0.5)
            return client.ask(GetExecutionState(0, 1), ExecutionStateChanged).flags & 2

        wait_for(is_paused, "Studio has paused the robot")
        display.close()
