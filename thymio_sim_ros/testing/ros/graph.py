"""A private ROS graph for one test: a context, executors, nodes under test, waiting that tells what went wrong."""

from __future__ import annotations

import contextlib
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, Protocol

import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import get_default_context, try_shutdown

from thymio_sim_ros.ros.rclpy_ext import log_directory
from thymio_sim_ros.ros.rclpy_ext.node_runner import deliver, make_executor
from thymio_sim_ros.testing.failure_messages import describe_condition
from thymio_sim_ros.testing.ros import discovery, student
from thymio_sim_ros.testing.ros.executor_turns import ExecutorTurns
from thymio_sim_ros.testing.ros.recorder import Recorder
from thymio_sim_ros.testing.sources import beside

__all__ = ["DEADLINE_S", "Ros"]

DEADLINE_S = 20.0
SLICE_S = 0.005
"""Real seconds that nodes under test wait at most while nothing comes for all others."""

DEPTH = 1000
"""Messages that a recorder may be behind."""

NOTICE = 2
"""Deliveries until a publisher knows of a subscription: the event, then the task that it makes."""

THREADS_S = 2.0
"""Real seconds for threads of nodes under test to see that ROS is shut down, and to end."""

TEST_NODE = "test"


class Stepped(Protocol):
    """What lets simulated time pass in a test."""

    @property
    def now(self) -> float:
        """Simulated time in s."""

    def until(self, condition: Callable[[], Any], seconds: float = 60.0, *, what: str = "") -> Any:
        """Let time pass until a condition is true."""

    def lines(self) -> list[str]:
        """How time and the robots are, for a person."""


class Ros:
    """A private context, one executor for what is ours and one for each node under test; `until` spins them."""

    def __init__(self, domain: int, *, folder: Path | None = None) -> None:
        """Files of nodes under test are looked for in `folder` first."""
        self.domain = domain
        self.simulation: Stepped | None = None
        """The simulation of this test, once there is one: it alone lets simulated time pass."""
        self._folder = folder
        self._threads = set(threading.enumerate())
        # Code under test may ask for the default context (`rclpy.ok()`); somebody else's is not touched.
        self.context = get_default_context()
        if self.context.ok():
            self.context = Context()
        log_directory.ensure()
        rclpy.init(args=[], context=self.context, domain_id=domain, signal_handler_options=SignalHandlerOptions.NO)
        # The events executor has crashes written to a file behind stderr: what `--capture=sys` gives has none.
        with contextlib.redirect_stderr(sys.__stderr__):
            self._executor = make_executor(self.context)
        self._lives: list[Any] = []
        self._nodes: list[Node] = []
        self._turns: dict[Node, ExecutorTurns] = {}
        """Of the nodes under test, in the order in which they were started."""
        self._recorders: list[Recorder] = []
        self.node = self.make_node(TEST_NODE)

    # --- nodes ---

    def make_node(self, name: str, namespace: str = "") -> Node:
        """A plain node on the test's executor."""
        node = Node(
            name, context=self.context, namespace=namespace, start_parameter_services=False, enable_rosout=False
        )
        self._executor.add_node(node)
        self._nodes.append(node)
        return node

    def add(self, node: Node) -> Node:
        """Give a node under test its turns; it is destroyed with the test."""
        self._nodes.append(node)
        with self._alive():
            self._turns[node] = ExecutorTurns(node, self.context)
        return node

    def live(self, life: Any) -> Any:
        """Put a `Life` on the executor; it is closed with the test."""
        self._executor.add_node(life.node)
        self._lives.append(life)
        return life

    def start(
        self,
        source: type[Node] | str | Path,
        *,
        class_name: str = "",
        name: str = "",
        namespace: str = "",
        parameters: Mapping[str, Any] | None = None,
        remappings: Mapping[str, str] | None = None,
        use_sim_time: bool | None = None,
        arguments: Mapping[str, Any] | None = None,
    ) -> Node:
        """Start a node under test, and wait until it has found its peers.

        `source` is its class, its file or its module; `arguments` are those of its constructor. It uses simulated time
        where the test has a simulation. What its constructor raises is raised here.
        """
        __tracebackhide__ = True
        kind = source if isinstance(source, type) else student.load_class(beside(source, self._folder), class_name)
        if use_sim_time is None:
            use_sim_time = self.simulation is not None
        values = {"use_sim_time": use_sim_time, **(parameters or {})}
        remap = student.remap_arguments(name, namespace, remappings or {})
        node = self.add(student.start(kind, self.context, remap, values, arguments or {}))
        self.settle()
        return node

    def stop(self, node: Node) -> None:
        """End a node of this test before the test ends."""
        self._nodes.remove(node)
        self._forget(node)
        node.destroy_node()

    def end(self, life: Any) -> None:
        """Close a `Life` before the test ends."""
        self._lives.remove(life)
        self._forget(life.node)
        life.close()

    def _forget(self, node: Node) -> None:
        """Let its executor do all that waits for a node, and then take its leave of it."""
        if node in self._turns:
            self._turns.pop(node).shutdown()
        else:
            self._executor.remove_node(node)
            self.deliver()

    # --- time ---

    def deliver(self) -> None:
        """Handle the messages that are there, waiting for none: first a turn of each node under test."""
        with self._alive():
            self._run_turns()
            deliver(self._executor)

    def spin(self) -> None:
        """One short turn of all executors."""
        with self._alive():
            self._run_turns()
            self._executor.spin_once(timeout_sec=SLICE_S)

    def _run_turns(self) -> None:
        for turns in tuple(self._turns.values()):
            turns.run()

    def until(
        self,
        condition: Callable[[], Any],
        timeout: float = DEADLINE_S,
        *,
        sim_time: float | None = None,
        what: str = "",
    ) -> Any:
        """Spin until the condition is true; returns its value, or fails the test and tells how everything is.

        With `sim_time` the simulation is stepped, at most so many simulated seconds, however long that takes. Without,
        it waits at most `timeout` seconds of real time, and simulated time stands still.
        """
        __tracebackhide__ = True
        if sim_time is not None:
            return self._simulated().until(condition, sim_time, what=what)
        hint = "" if self.simulation is None else "\n(simulated time stood still meanwhile: sim_time= lets it pass)"
        return self.spin_until(
            condition, timeout, lambda: f"not within {timeout:g} s: {what or describe_condition(condition)}{hint}"
        )

    def spin_until(self, condition: Callable[[], Any], timeout: float, head: Callable[[], str]) -> Any:
        """Spin until the condition is true, at most so many seconds of real time; the failure begins with `head()`."""
        __tracebackhide__ = True
        deadline = time.monotonic() + timeout
        while not (value := condition()):
            if time.monotonic() > deadline:
                self.fail(head())
            self.spin()
        return value

    def settle(self) -> None:
        """Wait until all nodes of this test have found each other, and know it.

        From then on no message between them is lost.
        """
        __tracebackhide__ = True
        nodes = [*self._nodes, *(life.node for life in self._lives)]
        self.until(lambda: discovery.all_matched(nodes), what="all publishers and subscriptions found each other")
        for _ in range(NOTICE):
            self.deliver()

    # --- topics and services ---

    def collect(
        self,
        kind: Any,
        topic: str,
        *,
        latched: bool | None = None,
        where: Callable[[Any], Any] | None = None,
        qos: QoSProfile | None = None,
    ) -> Recorder:
        """A list that fills with the topic's messages, those that satisfy `where` if given.

        It waits for a publisher and listens as that publishes; earlier messages of a latched topic arrive too, unless
        `latched` is false. With a `qos` of its own it waits for nobody.
        """
        __tracebackhide__ = True
        name = self.node.resolve_topic_name(topic)
        recorder = Recorder(kind, name, self.until, self.now, where)
        if qos is None:
            self.until(lambda: self.node.count_publishers(name), what=f"a publisher of {name}")
            qos = discovery.as_published(self.node, name, DEPTH, latched=latched)
        subscription = self.node.create_subscription(kind, name, recorder.add, qos)
        self._recorders.append(recorder)
        self.until(lambda: discovery.is_matched(self.node, subscription), what=f"the publishers of {name}")
        self.settle()
        return recorder

    def publisher(self, kind: Any, topic: str, *, depth: int = 10) -> Any:
        """A publisher that already has a subscriber."""
        __tracebackhide__ = True
        publisher = self.node.create_publisher(kind, topic, depth)
        self.until(publisher.get_subscription_count, what=f"a subscriber of {publisher.topic_name}")
        self.settle()
        return publisher

    def call(self, kind: Any, name: str, request: Any = None) -> Any:
        """The answer of a service."""
        __tracebackhide__ = True
        client = self.node.create_client(kind, name)
        self.until(client.service_is_ready, what=f"service {name}")
        future = client.call_async(kind.Request() if request is None else request)
        self.until(future.done, what=f"answer of {name}")
        return future.result()

    # --- reports and the end ---

    def now(self) -> str:
        """Simulated time for a person, or nothing without a simulation."""
        return "" if self.simulation is None else f"at {self.simulation.now:.2f} s"

    def fail(self, head: str) -> None:
        """Fail the test, and tell how robots, programs, records and topics are."""
        __tracebackhide__ = True
        lines = [head]
        if self.simulation is not None:
            lines += self.simulation.lines()
        lines += [repr(recorder) for recorder in self._recorders]
        ours = [TEST_NODE, *(life.node.get_name() for life in self._lives)]
        pytest.fail("\n".join([*lines, *discovery.topic_lines(self.node, ours)]))

    def close(self) -> None:
        """End lives, nodes, executor and context; nothing of them is left."""
        with contextlib.ExitStack() as end:  # each step is done even when another fails
            end.callback(self._close_context)
            end.callback(self._executor.shutdown)
            for node in self._nodes:
                end.callback(node.destroy_node)
                if node in self._turns:
                    end.callback(self._turns[node].shutdown)
                else:
                    end.callback(self._executor.remove_node, node)
            end.callback(self._end_threads)
            for life in self._lives:
                end.callback(life.close)
                end.callback(self._executor.remove_node, life.node)

    def _end_threads(self) -> None:
        """Shut ROS down before the nodes go, where threads of theirs run: what these ask is `rclpy.ok()`."""
        running = set(threading.enumerate()) - self._threads
        if running:
            self._close_context()
        deadline = time.monotonic() + THREADS_S
        for thread in running:
            thread.join(max(0.0, deadline - time.monotonic()))

    def _close_context(self) -> None:
        if self.context is get_default_context():
            try_shutdown()
        else:
            self.context.try_shutdown()

    @contextlib.contextmanager
    def _alive(self) -> Iterator[None]:
        """Tell what it means when the context ends in the middle of a test."""
        try:
            if not self.context.ok():
                raise ExternalShutdownException
            yield
        except ExternalShutdownException:
            pytest.fail("a node under test shut ROS down: rclpy.shutdown() belongs to main()")

    def _simulated(self) -> Stepped:
        if self.simulation is None:
            raise LookupError("sim_time needs a simulation: let the test call the fixture `simulation` first")
        return self.simulation
