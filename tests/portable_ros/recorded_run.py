"""Runs the suite with all of its topics subscribed, on whatever ROS graph there is; prints all messages as JSON.

    recorded_run.py record FILE    topics and services drive two robots with a program; FILE becomes the run log
    recorded_run.py replay FILE    the last run of FILE is shown, reset, and shown again

Everything is on one thread, and the clocks of the suite go on only between two rounds of its loop. So also what it does
by wall time, such as a status each second, comes at the same place of each run.
"""

from __future__ import annotations

import json
import sys
import time
from collections import Counter, defaultdict
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

import rclpy
from geometry_msgs.msg import TransformStamped, Twist, Vector3
from rcl_interfaces.msg import Log, Parameter, ParameterValue
from rcl_interfaces.srv import SetParameters
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import deserialize_message
from rclpy.subscription import Subscription
from std_msgs.msg import Bool, ColorRGBA, Empty, Float32, Float32MultiArray, Int8, Int16MultiArray, UInt8MultiArray
from std_srvs.srv import SetBool, Trigger

from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.names.type_names import type_name
from thymio_sim_ros.ros.combined import suite_nodes
from thymio_sim_ros.ros.compat.tf2_messages import TF_TYPE_NAME, TFMessage
from thymio_sim_ros.ros.rclpy_ext.node_runner import make_executor, nodes_of
from thymio_sim_ros.ros.simulator.node import Simulator
from thymio_sim_ros.suite_config import SuiteConfig

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message

PROGRAM = """\
<!DOCTYPE aesl-source>
<network>
<event size="2" name="pressed"/>
<event size="1" name="wish"/>
<node nodeId="1" name="red">var count = 0
call prox.comm.enable(1)
timer.period[0] = 100
onevent timer0
	count++
	leds.circle = [count % 32, 0, 0, 0, 0, 0, 0, 0]
onevent button.forward
	emit pressed [count, button.forward]
	motor.left.target = 150
	motor.right.target = 200
onevent wish
	call sound.freq(440 + event.args[0], 20)
	prox.comm.tx = event.args[0]
	emit wish event.args[0] + 1
</node>
<node nodeId="2" name="blue">var seen = 0
call prox.comm.enable(1)
onevent prox.comm
	seen = prox.comm.rx
onevent prox
	if prox.horizontal[2] > 2000 then
		motor.left.target = -100
		motor.right.target = -100
	end
onevent pressed
	seen = event.args[0]
	call leds.top(0, 32, 0)
</node>
</network>
"""
WATCHED = "aseba_runtime:robots.red.watch:=[count]"
LOG = "/rosout"
"""The topic whose messages rcl publishes itself."""
LAST_LINE = "the end"
DEPTH = 10_000
ROUND_NS = 50_000_000
"""Simulated time between two rounds: five ticks."""
START_NS = 1_000_000_000_000
PATIENCE = 6000
"""Rounds in which a condition must become true; one that has nothing to do waits for 10 ms."""


class WallClock(ModuleType):
    """Takes the place of the module `time` in the modules of the suite."""

    def __init__(self) -> None:
        super().__init__("time")
        self.now_ns = START_NS

    def __getattr__(self, name: str) -> Any:
        return getattr(time, name)

    def monotonic_ns(self) -> int:
        """The time in ns."""
        return self.now_ns

    def monotonic(self) -> float:
        """The time in s."""
        return self.now_ns * 1e-9

    def install(self) -> None:
        """Make it the clock of all modules of the suite's nodes."""
        for name, module in list(sys.modules.items()):
            if name.startswith("thymio_sim_ros.ros.") and getattr(module, "time", None) is time:
                vars(module)["time"] = self


class Counted:
    """Counts the calls of a method of a class, by what `key` returns for the object."""

    def __init__(self, owner: type, name: str, key: Callable[[Any], Any]) -> None:
        self.calls: Counter[Any] = Counter()
        inner = getattr(owner, name)

        def counting(one: Any, *args: Any) -> Any:
            self.calls[key(one)] += 1
            return inner(one, *args)

        setattr(owner, name, counting)


class Run:
    """A suite on one thread, and a node that is subscribed to all of its topics.

    Invariant: all published messages have been received whenever a method returns.
    """

    def __init__(self, suite: SuiteConfig) -> None:
        self._clock = WallClock()
        self._clock.install()
        self._context, self._others = Context(), Context()
        rclpy.init(args=["--ros-args", "-p", WATCHED], context=self._context)
        rclpy.init(args=[], context=self._others)
        self.node = rclpy.create_node(
            "observer", context=self._others, enable_rosout=False, start_parameter_services=False
        )
        self._observer = SingleThreadedExecutor(context=self._others)
        self._observer.add_node(self.node)
        self._inputs = Counted(Engine, "apply", lambda _: "")
        self._published = Counted(Publisher, "publish", lambda one: one.topic_name)
        self.topics: dict[str, str] = {}
        """The types of all topics of the suite by their names."""
        self.received: dict[str, list[bytes]] = defaultdict(list)
        self._missed: Counter[str] = Counter()
        """Messages that were published before there was a subscription, and not retained for it."""
        self._listen(Log, LOG, QoSProfile(depth=DEPTH, durability=DurabilityPolicy.TRANSIENT_LOCAL))
        (made,) = suite_nodes(self._context, suite)
        assert isinstance(made, Simulator)
        self.simulator = made
        self._nodes = nodes_of(made)
        self._executor = make_executor(self._context)
        for node in self._nodes:
            self._executor.add_node(node)
        timers = [timer for node in self._nodes for timer in node.timers]
        self._timers = [(timer.callback, timer.timer_period_ns) for timer in timers]
        for timer in timers:
            timer.cancel()
        self._subscribe()

    def go_on(self, seconds: float) -> None:
        """Run for a time of the suite's clock."""
        end_ns = self._clock.now_ns + round(seconds * 1e9)
        while self._clock.now_ns < end_ns:
            before_ns = self._clock.now_ns
            self._clock.now_ns += ROUND_NS
            for callback, period_ns in self._timers:
                if before_ns // period_ns != self._clock.now_ns // period_ns:
                    callback()
            self._until(lambda: True)

    def publish(self, topic: str, message: Any) -> None:
        """Publish a message and wait until it has become an input of the engine."""
        publisher = self.node.create_publisher(type(message), topic, 10)
        self._until(lambda: publisher.get_subscription_count() > 0)
        before = self._inputs.calls[""]
        publisher.publish(message)
        self._until(lambda: self._inputs.calls[""] > before)
        self.node.destroy_publisher(publisher)

    def call(self, kind: Any, name: str, request: Any) -> Any:
        """The response of a service."""
        client = self.node.create_client(kind, name)
        self._until(client.service_is_ready)
        future = client.call_async(request)
        self._until(future.done)
        self.node.destroy_client(client)
        return future.result()

    def set(self, name: str, parameter: Parameter) -> None:
        """Call a service of the type SetParameters with one parameter, which succeeds."""
        (result,) = self.call(SetParameters, name, SetParameters.Request(parameters=[parameter])).results
        assert result.successful, result.reason

    def succeed(self, kind: Any, name: str, request: Any) -> None:
        """Call a service that says whether it succeeds."""
        response = self.call(kind, name, request)
        assert response.success, response.message

    def close(self) -> dict[str, Any]:
        """End the suite; the type of each topic and all of its messages."""
        for node in self._nodes:
            node.get_logger().info(LAST_LINE)
        loggers = {node.get_logger().name for node in self._nodes}
        self._until(lambda: loggers <= {one.name for one in self._log() if one.msg == LAST_LINE})
        for node in self._nodes:
            self._executor.remove_node(node)
        self._executor.shutdown()
        self.simulator.close()
        self._context.try_shutdown()
        self._observer.shutdown()
        self.node.destroy_node()
        self._others.try_shutdown()
        return {
            name: {"type": kind, "messages": [data.hex() for data in self.received[name]]}
            for name, kind in sorted(self.topics.items())
        }

    def _log(self) -> list[Log]:
        return [deserialize_message(data, Log) for data in self.received[LOG]]

    def _until(self, condition: Callable[[], bool]) -> None:
        """Run without time until a condition is true and all messages have been received."""
        for _ in range(PATIENCE):
            self.simulator.run_once(self._executor)
            self._observer.spin_once(timeout_sec=0.0)
            if condition():
                break
        else:
            raise AssertionError("the condition has not become true")
        self._receive(lambda: not self._missing())
        self._subscribe()

    def _receive(self, condition: Callable[[], bool]) -> None:
        """Receive messages until a condition is true."""
        for _ in range(PATIENCE):
            if condition():
                return
            self._observer.spin_once(timeout_sec=0.01)
        raise AssertionError(f"missing: {self._missing()}")

    def _missing(self) -> dict[str, int]:
        """How many messages of which topics have not been received."""
        published = self._published.calls
        missing = {
            name: published[name] - self._missed[name] - len(self.received[name]) for name in self.topics if name != LOG
        }
        return {name: count for name, count in missing.items() if count}

    def _listen(self, kind: type[Message], topic: str, profile: QoSProfile) -> Subscription:
        self.topics[topic] = TF_TYPE_NAME if kind is TFMessage else type_name(kind)
        return self.node.create_subscription(kind, topic, self.received[topic].append, profile, raw=True)

    def _subscribe(self) -> None:
        """Subscribe to topics that are new, and wait until all of their messages will arrive."""
        publishers: dict[str, list[Publisher[Any]]] = defaultdict(list)
        for one in (one for node in self._nodes for one in node.publishers):
            if one.topic_name not in self.topics:
                publishers[one.topic_name].append(one)
        counted: dict[Subscription, int] = {}
        for topic, ends in publishers.items():
            profile = QoSProfile(depth=DEPTH, durability=ends[0].qos_profile.durability)
            counted[self._listen(ends[0].msg_type, topic, profile)] = len(ends)
        new = [one for ends in publishers.values() for one in ends]
        self._receive(lambda: all(one.get_publisher_count() >= count for one, count in counted.items()))
        self._receive(lambda: all(one.get_subscription_count() for one in new))
        for topic, ends in publishers.items():
            is_retained = ends[0].qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
            retained = len(ends) if is_retained else 0  # each of them keeps one
            self._missed[topic] = max(0, self._published.calls[topic] - retained)
        self._receive(lambda: not self._missing())


def record(file: str) -> Run:
    """Drive two robots: a first run, a reset, and a second one with everything."""
    run = Run(_suite(playground="two_robots", program=_program(file), log=file))
    run.go_on(1.0)
    run.publish("/red/cmd_vel", Twist(linear=Vector3(x=0.1), angular=Vector3(z=0.5)))
    run.go_on(0.7)
    run.succeed(Trigger, "/simulator/reset", Trigger.Request())
    run.go_on(0.5)
    run.publish("/red/_press/forward", Bool(data=True))
    run.go_on(0.2)
    run.publish("/red/_press/forward", Bool(data=False))
    run.publish("/red/_sound_threshold", Float32(data=0.1))
    run.publish("/red/_sound/samples", UInt8MultiArray(data=[100, 200] * 400))
    run.go_on(0.2)
    run.publish("/red/aseba/emit/wish", Int16MultiArray(data=[7]))
    run.publish("/red/pen/down", Bool(data=True))
    run.publish("/blue/led/body/top", ColorRGBA(r=1.0, a=1.0))
    run.publish("/blue/cmd_vel", Twist(linear=Vector3(x=0.12)))
    run.go_on(0.6)
    run.publish("/blue/_press/lift", Bool(data=True))
    run.publish("/blue/_press/tilt", Float32MultiArray(data=[0.2, -0.1]))
    run.publish("/red/_press/clap", Float32(data=0.9))
    run.go_on(0.3)
    run.publish("/blue/_press/lift", Bool(data=False))
    run.publish("/red/_press/tap", Empty())
    run.publish("/red/_press/remote", Int8(data=3))
    place = TransformStamped(child_frame_id="red")
    place.transform.translation.x, place.transform.rotation.w = -0.4, 1.0
    run.publish("/simulator/_place", place)
    run.go_on(0.2)
    run.succeed(SetBool, "/simulator/pause", SetBool.Request(data=True))
    for _ in range(3):
        run.succeed(Trigger, "/simulator/step", Trigger.Request())
    change = Parameter(name="out_of_range", value=ParameterValue(type=4, string_value="driver"))
    run.set("/simulator/set_parameters", change)
    start = ParameterValue(type=8, double_array_value=[0.0, -0.05, 1.0])
    run.set("/simulator/spawn", Parameter(name="late", value=start))
    variable = ParameterValue(type=7, integer_array_value=[1000])
    run.set("/red/aseba/set_variables", Parameter(name="count", value=variable))
    run.succeed(SetBool, "/simulator/pause", SetBool.Request(data=False))
    run.go_on(0.6)
    run.set("/simulator/remove", Parameter(name="late"))
    run.go_on(0.3)
    return run


def replay(file: str) -> Run:
    """Show the last run of a log, reset it and show its beginning again."""
    run = Run(_suite(replay=file, replay_from_s=0.0))
    for seconds in (60.0, 1.0):
        run.succeed(SetBool, "/simulator/pause", SetBool.Request(data=False))
        while not run.simulator.runner.paused and seconds > 0.0:
            run.go_on(ROUND_NS * 1e-9)
            seconds -= ROUND_NS * 1e-9
        run.succeed(Trigger, "/simulator/reset", Trigger.Request())
    return run


def _suite(**chosen: Any) -> SuiteConfig:
    return SuiteConfig(foxglove=False, web=False, **chosen)


def _program(log: str) -> str:
    file = Path(log).with_name("program.aesl")
    file.write_text(PROGRAM, encoding="utf-8")
    return str(file)


def main() -> None:
    """Record or replay, as the first argument says, with the file of the second one."""
    action, file = sys.argv[1:]
    run = {"record": record, "replay": replay}[action](file)
    print(json.dumps(run.close()))


if __name__ == "__main__":
    main()
