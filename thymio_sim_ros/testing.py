"""Launch-free pytest fixtures that spin executors: nodes under test live in the test's own process.

Each test has a context of its own in a domain of its own process; waiting is always for a condition with a
deadline, and simulated time is stepped, so that a slow machine changes nothing (ros-packaging.md section 7).

    def test_it_moves(ros, simulation):
        simulator = simulation(playground="base")
        publisher = ros.publisher(Twist, "cmd_vel")
        odometry = ros.collect(Odometry, "odom")
        ros.until(lambda: publisher.get_subscription_count() == 1)
        publisher.publish(Twist(linear=Vector3(x=0.1)))
        simulator.until(lambda: odometry and odometry[-1].pose.pose.position.x > 0.05)
"""

from __future__ import annotations

import os
import socket
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest
import rclpy
from rclpy.context import Context
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

from thymio_sim_ros.nodes.life import Life, deliver, make_executor
from thymio_sim_ros.sim.clock import TICK_NS

if TYPE_CHECKING:  # the nodes are imported by the test that wants them
    from thymio_sim_ros.nodes.aseba_node import AsebaRuntime
    from thymio_sim_ros.nodes.simulator_node import Simulator

DEADLINE_S = 20.0
SLICE_S = 0.02
HOPS = 2
"""Deliveries per tick: a reading reaches a node under test, and its command comes back."""

DOMAINS = range(1, 100)
DOMAIN_PORT = 17400
"""Loopback port of domain 0; holding port + id reserves a domain for this process."""


class Ros:
    """A private context with one executor; `until` spins it."""

    def __init__(self, domain: int) -> None:
        self.context = Context()
        rclpy.init(args=[], context=self.context, domain_id=domain)
        self._executor = make_executor(self.context)
        self._lives: list[Life] = []
        self._nodes: list[Node] = []
        self.node = self.make_node("test")

    def make_node(self, name: str) -> Node:
        """A plain node on the test's executor."""
        node = Node(name, context=self.context, start_parameter_services=False, enable_rosout=False)
        return self.add(node)

    def add(self, node: Node) -> Node:
        """Put a node under test on the executor; it is destroyed with the test."""
        self._executor.add_node(node)
        self._nodes.append(node)
        return node

    def live(self, life: Any) -> Any:
        """Put a `Life` on the executor; it is closed with the test."""
        self._executor.add_node(life.node)
        self._lives.append(life)
        return life

    def deliver(self) -> None:
        """Handle the messages that are there, waiting for none."""
        deliver(self._executor)

    def spin(self) -> None:
        """One short turn of the executor."""
        self._executor.spin_once(timeout_sec=SLICE_S)

    def until(self, condition: Callable[[], Any], timeout_s: float = DEADLINE_S, *, what: str = "") -> Any:
        """Spin until the condition is true; returns its value. Fails with what was waited for and the graph."""
        deadline = time.monotonic() + timeout_s
        while not (value := condition()):
            if time.monotonic() > deadline:
                pytest.fail(f"not within {timeout_s} s: {what or _source(condition)}; topics: {self._graph()}")
            self.spin()
        return value

    def collect(self, kind: Any, topic: str, *, latched: bool = False) -> list[Any]:
        """A list that fills with the topic's messages; `latched` asks for earlier ones too."""
        messages: list[Any] = []
        durability = DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
        profile = QoSProfile(depth=100, reliability=ReliabilityPolicy.RELIABLE, durability=durability)
        self.node.create_subscription(kind, topic, messages.append, profile)
        self.until(lambda: self.node.count_publishers(topic), what=f"a publisher of {topic}")
        return messages

    def publisher(self, kind: Any, topic: str, *, depth: int = 10) -> Any:
        """A publisher that already has a subscriber."""
        publisher = self.node.create_publisher(kind, topic, depth)
        self.until(publisher.get_subscription_count, what=f"a subscriber of {topic}")
        return publisher

    def call(self, kind: Any, name: str, request: Any = None) -> Any:
        """The answer of a service."""
        client = self.node.create_client(kind, name)
        self.until(client.service_is_ready, what=f"service {name}")
        future = client.call_async(kind.Request() if request is None else request)
        self.until(future.done, what=f"answer of {name}")
        return future.result()

    def close(self) -> None:
        """End lives, nodes, executor and context; nothing of them is left."""
        for life in reversed(self._lives):
            self._executor.remove_node(life.node)
            life.close()
        for node in self._nodes:
            self._executor.remove_node(node)
            node.destroy_node()
        self._executor.shutdown()
        self.context.try_shutdown()

    def _graph(self) -> str:
        return ", ".join(name for name, _ in self.node.get_topic_names_and_types())


class SimulationInTest:
    """The simulator, stepped by the test: counts simulated time, not wall time."""

    def __init__(self, ros: Ros, simulator: Simulator) -> None:
        self.ros = ros
        self.simulator = simulator

    @property
    def world(self) -> Any:
        """The world itself, for the truth."""
        return self.simulator.world

    def step(self, seconds: float) -> None:
        """Advance simulated time tick by tick, delivering messages in between."""
        for _ in range(round(seconds * 1e9 / TICK_NS)):
            self.tick()

    def tick(self) -> None:
        """One tick of 10 ms, then whatever messages are there."""
        self.simulator.advance(1)
        for _ in range(HOPS):
            self.ros.deliver()

    def until(self, condition: Callable[[], Any], seconds: float = 60.0, *, what: str = "") -> Any:
        """Step until the condition is true, at most so many simulated seconds; returns its value."""
        for _ in range(round(seconds * 1e9 / TICK_NS)):
            if value := condition():
                return value
            self.tick()
        return self.ros.until(condition, 2.0, what=what or f"{_source(condition)} in {seconds} simulated s")


@pytest.fixture(scope="session")
def ros_domain() -> Iterator[int]:
    """A ROS domain that no other test process of this machine uses; its children inherit it."""
    for domain in DOMAINS:
        lock = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        try:
            lock.bind(("127.0.0.1", DOMAIN_PORT + domain))
        except OSError:
            lock.close()
            continue
        before = {name: os.environ.get(name) for name in ("ROS_DOMAIN_ID", "ROS_AUTOMATIC_DISCOVERY_RANGE")}
        os.environ.update(ROS_DOMAIN_ID=str(domain), ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST")
        yield domain
        lock.close()
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
        return
    pytest.fail("no free ROS domain on this machine")


@pytest.fixture
def ros(ros_domain: int) -> Iterator[Ros]:
    """A private context and executor; afterwards no thread of ours is left."""
    threads = set(threading.enumerate())
    ros = Ros(ros_domain)
    yield ros
    ros.close()
    left = [thread.name for thread in set(threading.enumerate()) - threads if not thread.daemon]
    assert not left, f"threads left behind: {left}"


@pytest.fixture
def simulation(ros: Ros) -> Callable[..., SimulationInTest]:
    """Make a simulator node in this process, stepped by the test; keyword arguments are its parameters."""

    from thymio_sim_ros.nodes.simulator_node import Simulator, SimulatorParams

    def make(**parameters: Any) -> SimulationInTest:
        defaults = replace(SimulatorParams(playground="base", start_paused=True), **parameters)
        return SimulationInTest(ros, ros.live(Simulator(ros.context, defaults)))

    return make


@pytest.fixture
def runtime(ros: Ros) -> Callable[..., AsebaRuntime]:
    """Make an Aseba runtime node in this process: `runtime("onevent …")` or `runtime(path="line_follower")`."""

    from thymio_sim_ros.nodes.aseba_node import AsebaRuntime, RuntimeParams

    def make(source: str = "", *, path: str = "", **parameters: Any) -> AsebaRuntime:
        defaults = RuntimeParams(source=source, path=path, **parameters)
        node: AsebaRuntime = ros.live(AsebaRuntime(ros.context, defaults, use_sim_time=True))
        return node

    return make


def _source(condition: Callable[[], Any]) -> str:
    code = getattr(condition, "__code__", None)
    return f"{getattr(condition, '__qualname__', condition)} (line {code.co_firstlineno if code else '?'})"
