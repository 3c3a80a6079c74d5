"""Code under test that waits or raises what ends programs: it fails its own test, and says where."""

from __future__ import annotations

import signal
import sys
import threading

import pytest
from rclpy.node import Node
from std_msgs.msg import String

from tests.patience import PATIENCE_S
from tests.ros_graph import IS_EMBEDDED
from thymio_sim_ros.testing.ros import Ros
from thymio_sim_ros.testing.ros.containment import Containment
from thymio_sim_ros.testing.ros.student_errors import StudentError

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no signals for threads")

NODE = """\
import asyncio, concurrent.futures, os, queue, select, signal, subprocess, sys, threading, time
import pytest
import rclpy
from rclpy.duration import Duration
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.wait_for_message import wait_for_message
from std_msgs.msg import String
from std_srvs.srv import Trigger


class Waiting(Node):
    def __init__(self):
        super().__init__("waiting")
        self.rate = self.create_rate(10)
        self.client = self.create_client(Trigger, "nowhere")
        self.create_timer(0.1, self.tick)

    def tick(self):
        {}  # here


def main():
    rclpy.init()
    executor = MultiThreadedExecutor()
    executor.add_node(Waiting())
    executor.spin()


if __name__ == "__main__":
    main()
"""

RATE = "a wait for the next period of a rate" if IS_EMBEDDED else r"Rate\.sleep\(\)"
LINE = NODE.splitlines().index("        {}  # here") + 1

AT_ONCE = [
    "self.rate.sleep()",
    "self.client.call(Trigger.Request())",
    "self.get_clock().sleep_for(Duration(seconds=0.5))",
    "self.get_clock().sleep_until(self.get_clock().now() + Duration(seconds=1))",
    "rclpy.clock.Clock().sleep_for(Duration(seconds=3600))",
    "wait_for_message(String, self, 'nothing')",
    "wait_for_message(String, self, 'nothing', time_to_wait=3600)",
    "rclpy.spin(self)",
    "SingleThreadedExecutor().spin()",
    "MultiThreadedExecutor().spin_once()",
    "input()",
    "input('Speed? ')",
]

WAITS = [
    "threading.Event().wait()",
    "queue.Queue().get()",
    "[lock := threading.Lock(), lock.acquire(), lock.acquire()]",
    "[lock := threading.Condition(), lock.acquire(), lock.wait()]",
    "threading.Barrier(2).wait()",
    "threading.Thread(target=threading.Event().wait, daemon=True).start() or threading.enumerate()[-1].join()",
    "concurrent.futures.Future().result()",
    "asyncio.run(asyncio.Event().wait())",
    "select.select([os.pipe()[0]], [], [])",
    "os.read(os.pipe()[0], 1)",
    "subprocess.run(['sleep', '3600'])",
    "time.sleep(3600)",
    "any(map(time.sleep, iter(lambda: 0.01, 1)))",
    "signal.pause()",
]


def fails(ros, simulation, tmp_path, statement):
    """The failure of a node with this statement in its callback."""
    sim = simulation()
    path = tmp_path / "waiting.py"
    path.write_text(NODE.replace("{}", statement))
    ros.start(path)
    with pytest.raises(StudentError) as failed:
        sim.step(1.0)
    text = str(failed.value)
    place = f"it is at {path}, line {LINE}, in "
    # a function of the statement itself may be the one that runs
    assert f"{place}tick: {statement}" in text or f"{place}<lambda>: {statement}" in text, text
    return text


@pytest.fixture
def short(ros, monkeypatch):
    """Waits end sooner."""
    monkeypatch.setattr(ros._containment, "_wait_limit_s", 0.5)


@pytest.mark.parametrize("statement", AT_ONCE)
def test_a_wait_that_cannot_end_is_refused_at_once(ros, simulation, tmp_path, statement):
    """The middleware ignores signals; these hung for ever, and the next students were never graded."""
    text = fails(ros, simulation, tmp_path, statement)
    assert text.startswith("deadlock: ")
    assert "in a constructor or callback never ends" in text
    assert "ros.run" in text


@pytest.mark.process
@pytest.mark.parametrize("statement", WAITS)
def test_every_other_wait_is_interrupted(ros, simulation, tmp_path, short, statement):
    text = fails(ros, simulation, tmp_path, statement)
    assert text.startswith("the callback of node waiting for a timer waits and does not return")
    assert "ros.run" in text


def test_a_wait_for_a_service_ends_too(ros, simulation, tmp_path, short):
    """The embedded graph refuses it; that of an installed ROS does not tell of it."""
    text = fails(ros, simulation, tmp_path, "self.client.wait_for_service()")
    assert text.startswith("deadlock: a wait for service /nowhere" if IS_EMBEDDED else "the callback of node waiting")


@pytest.mark.parametrize("catches", ["Exception", "BaseException"])
def test_code_that_catches_everything_ends_too(ros, simulation, tmp_path, short, catches):
    path = tmp_path / "waiting.py"
    lines = ("while True:", "    try:", "        time.sleep(3600)", f"    except {catches}:", "        pass")
    loop = "\n        ".join(lines)
    path.write_text(NODE.replace("{}", loop))
    sim = simulation()
    ros.start(path)
    with pytest.raises(StudentError, match="waits and does not return"):
        sim.step(1.0)


@pytest.mark.parametrize(
    ("statement", "named"),
    [
        ("raise KeyboardInterrupt", "KeyboardInterrupt"),
        ("exit(0)", "SystemExit: 0"),
        ("os._exit(3)", "SystemExit: 3"),
        ("sys.exit('done')", "SystemExit: done"),
        ("raise GeneratorExit", "GeneratorExit"),
        ("raise asyncio.CancelledError", "CancelledError"),
        ("pytest.exit('over')", "Exit: over"),
        ("pytest.skip('no')", "Skipped: no"),
        ("raise type('Own', (BaseException,), {})", "Own"),
    ],
)
def test_what_would_end_pytest_fails_the_test(ros, simulation, tmp_path, statement, named):
    text = fails(ros, simulation, tmp_path, statement)
    assert text.startswith(f"the callback of node waiting for a timer raised {named}\n")


@pytest.mark.parametrize("statement", ["exit(3)", "raise KeyboardInterrupt", "time.sleep(3600)"])
@pytest.mark.parametrize("where", ["file", "constructor", "destroy_node"])
def test_the_same_holds_for_files_constructors_and_ends(ros, tmp_path, short, statement, where):
    head = "import time\nfrom rclpy.node import Node\n"
    node = "class Own(Node):\n    def __init__(self):\n        super().__init__('own')\n        {}\n"
    node += "    def destroy_node(self):\n        super().destroy_node()\n        {}\n"
    texts = {
        "file": head + statement + "\n" + node.format("pass", "pass"),
        "constructor": head + node.format(statement, "pass"),
        "destroy_node": head + node.format("pass", statement),
    }
    path = tmp_path / "own.py"
    path.write_text(texts[where])

    def start_and_stop():
        ros.stop(ros.start(path))

    with pytest.raises(StudentError, match=r"own\.py, line \d+, in ") as failed:
        start_and_stop()
    assert {"file": "while it is loaded", "constructor": "constructor of Own", "destroy_node": "destroy_node() of"}[
        where
    ] in str(failed.value)


def test_a_service_and_a_coroutine_are_contained_too(ros, short):
    class Serving(Node):
        def __init__(self):
            super().__init__("serving")
            self.create_subscription(String, "heard", self.hear, 10)

        async def hear(self, _message):
            threading.Event().wait()

    ros.start(Serving)
    ros.publisher(String, "heard").publish(String())
    with pytest.raises(StudentError, match="node serving for /heard waits"):
        ros.until(lambda: False)


class Goals(Node):
    """Accepts goals as an action server does: rclpy's server gives each accepted goal to the executor as a task."""

    def __init__(self):
        super().__init__("goals")
        self.rate = self.create_rate(20)
        self.create_subscription(String, "goal", self.accept, 10)

    def accept(self, _message):
        self.executor.create_task(self.execute, 90)

    async def execute(self, _degrees):
        self.rate.sleep()


class PlainGoals(Goals):
    def execute(self, _degrees):
        self.rate.sleep()


class GoalsThatWait(Goals):
    async def execute(self, _degrees):
        threading.Event().wait()


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        (Goals, "deadlock: RATE in a constructor or callback never ends"),
        (PlainGoals, "deadlock: RATE in a constructor or callback never ends"),
        (GoalsThatWait, "the callback of node goals for a task waits and does not return"),
    ],
)
def test_the_goal_of_an_action_is_contained_too(ros, short, kind, said):
    """The wheels have no action type, so the test makes the task itself that `ActionServer` makes of a goal."""
    ros.start(kind)
    ros.publisher(String, "goal").publish(String())
    said = said.replace("RATE", RATE)
    with pytest.raises(
        StudentError, match=rf"{said}[^\n]*\n  it is at .*test_containment\.py.* in execute: "
    ) as failed:
        ros.until(lambda: False)
    assert "ros.run" in str(failed.value)


def test_ctrl_c_still_ends_the_tests():
    containment = Containment()
    try:
        with pytest.raises(KeyboardInterrupt), containment.contain(lambda: "it", 1.0):
            signal.raise_signal(signal.SIGINT)
    finally:
        containment.close()


def test_short_waits_and_those_of_threads_are_allowed(ros, simulation, tmp_path):
    """A thread may wait for messages; a callback may sleep a little."""
    path = tmp_path / "waiting.py"
    waits = "threading.Thread(target=self.rate.sleep, daemon=True).start() or time.sleep(0.01)"
    waits += " or setattr(self, 'is_done', True)"
    path.write_text(NODE.replace("{}", waits))
    sim = simulation()
    node = ros.start(path)
    sim.step(1.0)
    assert node.is_done


def test_handlers_of_signals_are_restored(ros_domain):
    numbers = (signal.SIGINT, signal.SIGVTALRM)
    before = [signal.getsignal(number) for number in numbers]
    ros = Ros(ros_domain)
    ros.close()
    assert [signal.getsignal(number) for number in numbers] == before


@pytest.mark.process
def test_the_tests_after_it_run(pytester):
    """One student's endless wait, Ctrl-C and exit do not touch the next."""
    pytester.makepyfile(f"""
        import pytest

        @pytest.mark.parametrize("statement", ["raise KeyboardInterrupt", "exit(0)", "self.rate.sleep()", "pass"])
        def test_it(ros, simulation, tmp_path, statement):
            path = tmp_path / "own.py"
            path.write_text({NODE!r}.replace("{{}}", statement))
            sim = simulation()
            ros.start(path)
            sim.step(0.3)
    """)
    done = pytester.runpytest_subprocess("-p", "thymio_sim_ros.pytest_plugin", timeout=PATIENCE_S)
    done.assert_outcomes(passed=1, failed=3)
