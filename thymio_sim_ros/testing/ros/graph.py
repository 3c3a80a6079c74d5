"""A private ROS graph for one test: context, executors, nodes under test, waits that report the state on failure."""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, TypeVar, cast

import pytest
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile

from thymio_sim_ros.lockstep.matching import all_matched, is_matched
from thymio_sim_ros.ros.compat import dds_profile
from thymio_sim_ros.ros.rclpy_ext.connections import CLIENT, PUBLISHER, SUBSCRIBER, Connections
from thymio_sim_ros.ros.rclpy_ext.local_node import LocalNode, LocalTopic
from thymio_sim_ros.ros.rclpy_ext.node_runner import RunnableNode, deliver, make_executor, nodes_of
from thymio_sim_ros.testing.awaited import Awaited
from thymio_sim_ros.testing.failure_messages import describe_condition
from thymio_sim_ros.testing.record import SECOND_NS
from thymio_sim_ros.testing.ros import discovery, student
from thymio_sim_ros.testing.ros.containment import Containment
from thymio_sim_ros.testing.ros.cpu_limit import CPU_LIMIT_S, START_CPU_S
from thymio_sim_ros.testing.ros.executor_turns import ExecutorTurns
from thymio_sim_ros.testing.ros.private_context import PrivateContext
from thymio_sim_ros.testing.ros.program import OUTPUT_BYTES, Program
from thymio_sim_ros.testing.ros.program_files import find
from thymio_sim_ros.testing.ros.programs import Programs
from thymio_sim_ros.testing.ros.recorder import Recorder
from thymio_sim_ros.testing.ros.student_errors import StudentError
from thymio_sim_ros.testing.sources import beside

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message, Service

__all__ = ["DEADLINE_S", "Ros"]

T = TypeVar("T")
L = TypeVar("L", bound=RunnableNode)
M = TypeVar("M", bound="Message")
Q = TypeVar("Q", bound="Message")
R = TypeVar("R", bound="Message")

DEADLINE_S = 20.0
"""Initial `Ros.deadline_s`."""

SLICE_S = 0.005
"""Longest wait of the executors in one turn, in s of real time."""

LONG_S = 2.0
"""Real time of a constructor above which failure reports name it, in s."""

DEPTH = 1000
"""Queue depth of a recorder's subscription."""

NOTICE = 2
"""Deliveries until a publisher knows a subscription: the event, then the task that the event creates."""

TEST_NODE = "test"


class Stepped(Protocol):
    """The owner of simulated time in a test."""

    @property
    def now(self) -> float:
        """Simulated time in s."""

    def until(self, condition: Callable[[], T], seconds: float = 60.0, *, what: str = "") -> T:
        """Advance simulated time until a condition is true."""

    def lines(self) -> list[str]:
        """Describe time and robots, one line each."""


class Ros:
    """A private context, one executor for the nodes of this package and one per node under test; `until` spins all."""

    deadline_s: float = DEADLINE_S
    """Default deadline of waits in which simulated time does not pass, in s of real time on an idle machine.

    A wait for nodes in another process may need more on a machine that is busy.
    """

    def __init__(self, domain: int, *, folder: Path | None = None, output_limit: int = OUTPUT_BYTES) -> None:
        """`folder`: where files of nodes under test are searched first.

        `output_limit`: bytes that a program may print.
        """
        self.domain = domain
        self.simulation: Stepped | None = None
        """The simulation of this test, if there is one; it owns simulated time."""
        self._folder, self._output_limit = folder, output_limit
        self._containment = Containment()
        self._context = PrivateContext(domain)
        self.context = self._context.context
        # The events executor writes crash reports to the file behind stderr, which `--capture=sys` does not provide.
        with contextlib.redirect_stderr(sys.__stderr__):
            self._executor = make_executor(self.context)
        self._lives: list[RunnableNode] = []
        self._nodes: list[Node] = []
        self._turns: dict[Node, ExecutorTurns] = {}
        """Executors of the nodes under test, in the order in which these were started."""
        self._recorders: list[Recorder[Any]] = []
        self._remarks: list[str] = []
        with dds_profile.used(dds_profile.ANNOUNCING):  # programs find the participant of this node at once
            self.node = self.make_node(TEST_NODE)
        self.programs = Programs(self.context, self._all_nodes)

    # --- nodes ---

    def make_node(self, name: str, namespace: str = "") -> Node:
        """Create a plain node on the test's executor."""
        node = Node(
            name, context=self.context, namespace=namespace, start_parameter_services=False, enable_rosout=False
        )
        self._executor.add_node(node)
        self._nodes.append(node)
        return node

    def add(self, node: Node, *, cpu_limit: float = CPU_LIMIT_S) -> Node:
        """Add a node under test; it gets an executor of its own and is destroyed when the test ends."""
        self._nodes.append(node)
        with self._context.alive():
            self._turns[node] = ExecutorTurns(node, self.context, self._containment, cpu_limit)
        return node

    def live(self, life: L) -> L:
        """Add a node of this package (`RunnableNode`) to the test's executor; it is closed when the test ends."""
        for node in nodes_of(life):
            self._executor.add_node(node)
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
        cpu_limit: float = CPU_LIMIT_S,
    ) -> Node:
        """Start a node under test, and wait until it has found its peers.

        Args:
            source: Its class, its file or its module.
            class_name: Name of its class if a file or module has several.
            name: Name of the node, if not its own.
            namespace: Namespace of the node.
            parameters: Values of parameters.
            remappings: Names and what they are remapped to.
            use_sim_time: Whether it uses simulated time; None: if the test has a simulation.
            arguments: Arguments of its constructor.
            cpu_limit: Processor time in s that one of its callbacks may use; more fails the test.

        Raises:
            StudentError: The source has no node class, or several, or does not call `super().__init__`.
            Exception: Whatever the constructor raises.
        """
        __tracebackhide__ = True
        if isinstance(source, type):
            kind = source
        else:
            with self._containment.contain(lambda: f"{source}, while it is loaded,", START_CPU_S):
                kind = student.load_class(beside(source, self._folder), class_name)
        if use_sim_time is None:
            use_sim_time = self.simulation is not None
        values = {"use_sim_time": use_sim_time, **(parameters or {})}
        remap = student.remap_arguments(name, namespace, remappings or {})
        with self._constructing(kind):
            node = student.start(kind, self.context, remap, values, arguments or {})
        self.add(node, cpu_limit=cpu_limit)
        self.settle()
        return node

    @contextlib.contextmanager
    def _constructing(self, kind: type[Node]) -> Iterator[None]:
        """Limit the processor time of a constructor; failure reports name one that takes long."""
        place = f"the constructor of {kind.__name__} ({student.place(kind)})"
        wall_s, cpu_s = time.monotonic(), time.process_time()
        with self._containment.contain(lambda: place, START_CPU_S):
            yield
        wall_s, cpu_s = time.monotonic() - wall_s, time.process_time() - cpu_s
        if wall_s > LONG_S:
            self._remarks.append(f"{place} took {wall_s:.1f} s of real time, {cpu_s:.1f} s of processor time")

    def run(
        self,
        source: str | Path,
        *,
        executable: str = "",
        name: str = "",
        namespace: str = "",
        parameters: Mapping[str, Any] | None = None,
        remappings: Mapping[str, str] | None = None,
        arguments: Sequence[str] = (),
        stdin: str | Sequence[tuple[float, str]] | None = None,
        check: bool = True,
        cpu_limit: float = CPU_LIMIT_S,
    ) -> Program:
        """Start a program in a process of its own, and return when it waits for the first time.

        Args:
            source: Its file, its module (as for `python -m`), or its package if there is an `executable`.
            executable: Name of a Python program of that package (as for `ros2 run`).
            name: Name of its node, if not its own.
            namespace: Namespace of its nodes.
            parameters: Values of parameters.
            remappings: Names and what they are remapped to.
            arguments: Its command line.
            stdin: What is typed: lines that are there at once, or times (simulated s after the start) and lines;
                then the input ends. None: nothing but what `Program.type` types.
            check: Whether an exit code other than 0 fails the test.
            cpu_limit: Processor time in s that it may use without a wait.

        Raises:
            StudentError: There is no such file, module or executable, or this is Windows.
            LookupError: The test has no simulation.
        """
        __tracebackhide__ = True
        if sys.platform == "win32":
            raise StudentError(
                "ros.run: found Windows, expected Linux or macOS: test the node with ros.start, or in WSL 2"
            )
        simulation = self._simulated()
        target = find(source, executable, self._folder)
        values = {"use_sim_time": True, **(parameters or {})}
        program = Program(
            target.title,
            check=check,
            until=simulation.until,
            cpu_limit=cpu_limit,
            output_limit=self._output_limit,
        )
        ros_arguments = student.remap_arguments(name, namespace, remappings or {}, values)
        self.programs.start(program, target, [*arguments, *ros_arguments], stdin=stdin, now_ns=self._now_ns())
        for _ in range(NOTICE):
            self.deliver()
        return program

    def stop(self, node: Node) -> None:
        """Destroy a node before the test ends."""
        self._nodes.remove(node)
        self._forget(node)
        self._destroy(node)

    def _destroy(self, node: Node) -> None:
        what = f"destroy_node() of {node.get_name()}"
        with self._containment.contain(lambda: what, CPU_LIMIT_S):
            node.destroy_node()

    def end(self, life: RunnableNode) -> None:
        """Close a node added by `live` before the test ends."""
        self._lives.remove(life)
        for node in nodes_of(life):
            self._forget(node)
        life.close()

    def _forget(self, node: Node) -> None:
        """Handle all pending work of a node, then remove it from its executor."""
        if node in self._turns:
            self._turns.pop(node).shutdown()
        else:
            self._executor.remove_node(node)
            self.deliver()

    # --- time ---

    def deliver(self) -> None:
        """Handle all pending messages without waiting, those of nodes under test first."""
        with self._context.alive():
            self._run_turns()
            deliver(self._executor)

    def spin(self) -> None:
        """Spin all executors once, for `SLICE_S` at most."""
        if self.programs.running:
            self.programs.take_turns(self._now_ns())
        with self._context.alive():
            self._run_turns()
            self._executor.spin_once(timeout_sec=SLICE_S)

    def _run_turns(self) -> None:
        for turns in tuple(self._turns.values()):
            turns.run()

    def until(
        self,
        condition: Callable[[], T],
        timeout: float | None = None,
        *,
        sim_time: float | None = None,
        what: str = "",
    ) -> T:
        """Spin until the condition is true and return its value; fails the test with a report otherwise.

        With `sim_time`, the simulation is stepped by at most that many simulated seconds, however long that takes.
        Without it, the wait lasts at most `timeout` seconds (`deadline_s` if None) of real time on an idle machine, and
        simulated time does not pass. A condition that needs the first message of a topic waits for it
        (`Recorder.latest`). Raises LookupError for `sim_time` without a simulation.
        """
        __tracebackhide__ = True
        if sim_time is not None:
            return self._simulated().until(condition, sim_time, what=what)
        hint = "" if self.simulation is None else "\n(simulated time stood still meanwhile: sim_time= lets it pass)"
        timeout = self.deadline_s if timeout is None else timeout
        return self.spin_until(
            condition, timeout, lambda: f"not within {timeout:g} s: {what or describe_condition(condition)}{hint}"
        )

    def spin_until(self, condition: Callable[[], T], timeout: float, head: Callable[[], str]) -> T:
        """Spin until the condition is true, for at most `timeout` s; `head()` begins a failure report.

        A turn counts as `SLICE_S` at most, so that a busy machine, on which it takes longer, has more real time.
        """
        __tracebackhide__ = True
        awaited = Awaited(condition)
        rest_s = timeout
        while not (value := awaited()):
            if rest_s <= 0:
                self.fail(head() + awaited.missing())
            begin_s = time.monotonic()
            self.spin()
            rest_s -= min(time.monotonic() - begin_s, SLICE_S)
        return value

    def settle(self) -> None:
        """Wait until all nodes of this test are matched with each other.

        No message between them is lost from then on.
        """
        __tracebackhide__ = True
        nodes = self._all_nodes()
        self.until(lambda: all_matched(nodes), what="all publishers and subscriptions found each other")
        if self.programs.running:
            self.programs.settle()
        for _ in range(NOTICE):
            self.deliver()

    # --- topics and services ---

    def collect(
        self,
        kind: type[M],
        topic: str,
        *,
        transient_local: bool | None = None,
        where: Callable[[M], object] | None = None,
        qos: QoSProfile | int | None = None,
    ) -> Recorder[M]:
        """A list that is filled with the messages of a topic, or with those that satisfy `where`.

        Waits for a publisher and uses its QoS. With durability transient local, earlier messages arrive too, unless
        `transient_local` is false. With `qos`, it does not wait.
        """
        __tracebackhide__ = True
        name = self.node.resolve_topic_name(topic)
        recorder = Recorder(kind, name, self.until, self.now, where)
        if (local := self._local_topic(name)) is not None:
            for message in local.retained if transient_local is not False else ():
                recorder.add(message)
            local.callbacks.append(recorder.add)
            self._recorders.append(recorder)
            return recorder
        if qos is None:
            self.until(lambda: self.node.count_publishers(name), what=f"a publisher of {name}")
            qos = discovery.as_published(self.node, name, DEPTH, transient_local=transient_local)
        with student.types_explained(self.node, SUBSCRIBER, kind, name):
            subscription = self.node.create_subscription(kind, name, recorder.add, qos)
        self._recorders.append(recorder)
        if misfit := discovery.misfit(self.node, kind, name, qos):
            self.fail(misfit)
        self.until(lambda: is_matched(self.node, subscription), what=f"the publishers of {name}")
        self.settle()
        return recorder

    def publisher(self, kind: type[M], topic: str, *, depth: int = 10) -> Publisher[M] | LocalTopic:
        """Create a publisher, and wait until it has a subscriber."""
        __tracebackhide__ = True
        if (local := self._local_topic(self.node.resolve_topic_name(topic))) is not None:
            return local
        with student.types_explained(self.node, PUBLISHER, kind, topic):
            publisher = self.node.create_publisher(kind, topic, depth)
        self.until(publisher.get_subscription_count, what=f"a subscriber of {publisher.topic_name}")
        self.settle()
        return publisher

    def call(self, kind: type[Service[Q, R]], name: str, request: Q | None = None) -> R:
        """Call a service and return its response."""
        __tracebackhide__ = True
        full = self.node.resolve_service_name(name)
        if (answer := next(filter(None, (local.service(full) for local in self._local_nodes())), None)) is not None:
            response: R = answer(kind.Request() if request is None else request)
            return response
        with student.types_explained(self.node, CLIENT, kind, name):
            client = self.node.create_client(kind, name)
        self.until(client.service_is_ready, what=f"service {name}")
        future = client.call_async(kind.Request() if request is None else request)
        self.until(future.done, what=f"answer of {name}")
        return cast(R, future.result())  # done, and not canceled

    def _local_topic(self, name: str) -> LocalTopic | None:
        return next(filter(None, (local.topic(name) for local in self._local_nodes())), None)

    def _local_nodes(self) -> list[LocalNode]:
        """The nodes of this package with endpoints that only this process reaches."""
        controls = (getattr(life, "control", None) for life in self._lives)
        return [control for control in controls if isinstance(control, LocalNode)]

    def _all_nodes(self) -> list[Node]:
        return [*self._nodes, *(life.node for life in self._lives)]

    def _now_ns(self) -> int:
        return 0 if self.simulation is None else round(self.simulation.now * SECOND_NS)

    # --- reports and the end ---

    def now(self) -> str:
        """Describe simulated time; empty without a simulation."""
        return "" if self.simulation is None else f"at {self.simulation.now:.2f} s"

    def fail(self, head: str) -> None:
        """Fail the test with a report on robots, programs, recorded messages and topics."""
        __tracebackhide__ = True
        lines = [head]
        if self.simulation is not None:
            lines += self.simulation.lines()
        lines += [*self._remarks, *self.programs.lines()]
        lines += [repr(recorder) for recorder in self._recorders]
        ours = [TEST_NODE, *(life.node.get_name() for life in self._lives)]
        for life in self._lives:
            lines += [str(connection) for connection in Connections(life.node).find(is_settled=True)]
        pytest.fail("\n".join([*lines, *discovery.topic_lines(self.node, ours)]))

    def close(self) -> None:
        """Close all nodes, executors and the context."""
        with contextlib.ExitStack() as end:  # each step is done even when another fails
            end.callback(self._containment.close)
            end.callback(self._context.close)
            end.callback(self._executor.shutdown)
            for node in self._nodes:
                end.callback(self._destroy, node)
                if node in self._turns:
                    end.callback(self._turns[node].shutdown)
                else:
                    end.callback(self._executor.remove_node, node)
            end.callback(self._context.end_threads)
            for life in self._lives:
                end.callback(life.close)
                end.callback(self._executor.remove_node, life.node)
            end.callback(self.programs.close, self._now_ns())

    def _simulated(self) -> Stepped:
        if self.simulation is None:
            raise LookupError("sim_time needs a simulation: let the test call the fixture `simulation` first")
        return self.simulation
