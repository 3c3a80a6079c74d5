"""ExecutorTurns and threads of nodes under test: what `rclpy.spin` does elsewhere, in simulated time and in order."""

from __future__ import annotations

import threading

import pytest
import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node
from std_msgs.msg import String
from std_srvs.srv import Trigger

from tests.patience import PATIENCE_S
from tests.testing.ros.test_graph import Echo
from thymio_sim_ros.testing.ros import Ros
from thymio_sim_ros.testing.ros.forbidden_waits import waiting_forbidden
from thymio_sim_ros.testing.ros.student_errors import StudentError


class TwoTimers(Node):
    """Notes when each of two timers calls, in ms."""

    def __init__(self):
        super().__init__("two_timers")
        self.calls = []
        self.create_timer(0.05, lambda: self.calls.append(("first", self.now_ms())))
        self.create_timer(0.03, lambda: self.calls.append(("second", self.now_ms())))

    def now_ms(self):
        return self.get_clock().now().nanoseconds // 1_000_000


class Patient(Node):
    """Its callbacks are coroutines: one asks a service for what it says, the other falls over."""

    def __init__(self):
        super().__init__("patient")
        self.mouth = self.create_publisher(String, "said", 10)
        self.door = self.create_client(Trigger, "door", callback_group=ReentrantCallbackGroup())
        self.create_subscription(String, "heard", self.hear, 10)

    async def hear(self, message):
        if message.data == "bang":
            raise ValueError("I fell over")
        answer = await self.door.call_async(Trigger.Request())
        self.mouth.publish(String(data=answer.message))


class Looping(Node):
    """Publishes from a thread of its own as long as ROS is there."""

    def __init__(self):
        super().__init__("looping")
        self.mouth = self.create_publisher(String, "said", 10)
        self.failures = []
        self.thread = threading.Thread(target=self.loop)
        self.thread.start()

    def loop(self):
        pause = threading.Event()
        try:
            while rclpy.ok(context=self.context):
                self.mouth.publish(String(data="la"))
                pause.wait(0.05)
        except Exception as error:  # whatever it is, it would be reported in another test
            self.failures.append(error)


@pytest.mark.parametrize("_again", range(4))
def test_timers_are_called_when_they_are_due_and_in_their_order(ros, simulation, _again):
    """The events executor called the second twice at 60 ms, not at 90 ms, and at 150 ms now first, now last."""
    sim = simulation()
    node = ros.start(TwoTimers)
    sim.step(0.31)
    due = [("first", 50 * n) for n in range(1, 7)] + [("second", 30 * n) for n in range(1, 11)]
    assert node.calls == sorted(due, key=lambda call: (call[1], call[0]))


def test_callbacks_may_be_coroutines(ros):
    ros.node.create_service(Trigger, "door", lambda _request, answer: Trigger.Response(message="open"))
    ros.start(Patient)
    said = ros.collect(String, "said")
    heard = ros.publisher(String, "heard")
    heard.publish(String(data="hello"))
    assert said.next().data == "open"
    heard.publish(String(data="bang"))
    with pytest.raises(ValueError, match="I fell over"):
        ros.until(lambda: False)


def test_nodes_that_answer_each_other_do_not_keep_time_from_passing(ros, simulation):
    sim = simulation()
    ros.start(Echo, name="one", remappings={"said": "heard"})
    ros.start(Echo, name="two")
    ros.publisher(String, "heard").publish(String(data="again"))
    sim.step(0.1)
    assert sim.now == pytest.approx(0.1)


def test_threads_that_ask_whether_ros_is_there_end_before_their_node_does(ros_domain):
    ros = Ros(ros_domain)
    node = ros.start(Looping)
    ros.collect(String, "said").wait(2)
    ros.close()
    assert not node.thread.is_alive()
    assert node.failures == []


class Spinning(Node):
    """Waits for an answer as it begins, or when it hears something."""

    def __init__(self, at_once):
        super().__init__("spinning")
        self.door = self.create_client(Trigger, "door")
        self.create_subscription(String, "heard", self.ask, 10)
        if at_once:
            self.ask()

    def ask(self, _message=None):
        rclpy.spin_until_future_complete(self, self.door.call_async(Trigger.Request()))


@pytest.mark.parametrize("at_once", [True, False])
def test_spinning_where_nothing_can_arrive_is_an_error(ros, at_once):
    """It waited for ever, and no signal reached it."""
    ros.node.create_service(Trigger, "door", lambda _request, answer: answer)

    def ask():
        ros.start(Spinning, arguments={"at_once": at_once})
        ros.publisher(String, "heard").publish(String())
        ros.until(lambda: False)

    with pytest.raises(StudentError, match=r"deadlock: .* in a constructor or callback never ends"):
        ask()


def test_a_spin_imported_by_name_is_an_error_too(ros, tmp_path):
    path = tmp_path / "spinning.py"
    path.write_text(
        "from rclpy import spin\nfrom rclpy.node import Node\n"
        "class Spinning(Node):\n    def __init__(self):\n        super().__init__('spinning')\n        spin(self)\n"
    )
    with pytest.raises(StudentError, match=r"deadlock: .* in a constructor or callback never ends"):
        ros.start(path)


def test_a_spin_with_a_time_limit_or_in_a_thread_is_its_own_affair(ros):
    node = ros.start(Echo)
    with waiting_forbidden():
        rclpy.spin_once(node, timeout_sec=0)
        rclpy.spin_until_future_complete(node, rclpy.Future(), None, 0)
        thread = threading.Thread(target=rclpy.spin_once, args=(node,), daemon=True)
        thread.start()
        ros.publisher(String, "heard").publish(String(data="x"))
        thread.join(PATIENCE_S)
    assert not thread.is_alive()
