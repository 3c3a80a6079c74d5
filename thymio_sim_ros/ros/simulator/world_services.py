"""Control of time and world: services and topics of the simulator that belong to no robot (docs/ros.md).

Robots come, go and are put somewhere by services of `rcl_interfaces`, since only those among the standard ones carry
names and values and answer each with a reason. What is dragged in a viewer moves by a topic.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from geometry_msgs.msg import TransformStamped
from rcl_interfaces.msg import ParameterType, ParameterValue, SetParametersResult
from rcl_interfaces.srv import GetParameters, SetParameters
from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python
from std_srvs.srv import SetBool, Trigger

from thymio_sim_ros.ros.interface import convert_readings, qos
from thymio_sim_ros.ros.interface.headers import SECOND_NS
from thymio_sim_ros.ros.interface.names import RobotNames
from thymio_sim_ros.ros.rclpy_ext.throttled_log import ThrottledLog
from thymio_sim_ros.sim.commands import MoveObject, MoveRobot
from thymio_sim_ros.sim.model import fields
from thymio_sim_ros.sim.model.fields import FieldError
from thymio_sim_ros.sim.playground import writer
from thymio_sim_ros.sim.playground.reader import RobotStart
from thymio_sim_ros.sim.world import World

__all__ = ["PLACE_MEANING", "PLACE_TOPIC", "SERVICES", "SimulatorControl", "WorldServices", "at_current_tick"]


@dataclass(frozen=True, slots=True)
class Service:
    """One service: its type and what it does."""

    type: type
    about: str


SERVICES: Mapping[str, Service] = {
    "~/pause": Service(SetBool, "true: time stands still, false: it goes on"),
    "~/step": Service(Trigger, "`step_ticks` ticks of 10 ms; refused unless paused"),
    "~/reset": Service(Trigger, "world, time and noise as at the start; `/clock` goes back to 0"),
    "~/spawn": Service(SetParameters, "add robots: name → [x, y, yaw] in m and rad, yaw may be left out"),
    "~/remove": Service(SetParameters, "take robots away: names, values do not matter"),
    "~/set_poses": Service(SetParameters, "put robots and movable things somewhere: name → [x, y, yaw]"),
    "~/get_poses": Service(
        GetParameters, "where robots, movable things and doors are: names → [x, y, yaw]; NOT_SET: nowhere"
    ),
    "~/get_playground": Service(Trigger, "`message` is the playground as JSON of our format, with its pictures"),
}
"""Every service of the simulator that belongs to no robot."""

PLACE_TOPIC = "~/_place"
"""The topic that does what `~/set_poses` does, for what a viewer drags."""

WORLD_STOPPED = "the world stopped by a fault of ours: see the simulator's log"
PLACE_MEANING = "put a robot or a movable thing there: its name, or a robot's frame, is `child_frame_id`"


class SimulatorControl(Protocol):
    """What is controlled: the simulator."""

    @property
    def world(self) -> World:
        """The world of now."""

    @property
    def names(self) -> Mapping[str, RobotNames]:
        """The names in ROS of the robots, by those in the world."""

    @property
    def paused(self) -> bool:
        """Whether time stands still."""

    def pause(self, paused: bool) -> None:
        """Let time stand still or go on."""

    @property
    def map_frame(self) -> str:
        """Name of the world's frame."""

    @property
    def playground(self) -> str:
        """The playground as it was given: name, path or text."""

    @property
    def playground_name(self) -> str:
        """Its name."""

    def step(self, ticks: int | None = None) -> bool:
        """Let so many ticks pass, or those of one step; whether the world could go so far."""

    def spawn(self, start: RobotStart) -> None:
        """Add a robot; ValueError as of the world, and for a name that topics of a nameless robot begin with."""

    def reset(self) -> None:
        """World, time and noise as at the start."""

    def load(self, playground: str) -> str:
        """Another playground by name, path or text; the reason if it is refused."""

    def catch_up(self) -> None:
        """Be at the present tick, and tell early what the next one brings."""

    def update_robots(self) -> None:
        """Robots have come or gone."""

    def count_refusal(self) -> None:
        """A message was refused."""


Handler = Callable[[Any, Any], Any]


def at_current_tick(simulator: SimulatorControl, handler: Handler) -> Handler:
    """The same handler of a service, which finds the world at the present tick."""

    def handle(request: Any, response: Any) -> Any:
        simulator.catch_up()
        return handler(request, response)

    return handle


class WorldServices:
    """The services of a simulator, on its node."""

    def __init__(self, node: Node, simulator: SimulatorControl) -> None:
        self._simulator, self._warn = simulator, ThrottledLog(node)
        handlers: dict[str, Handler] = {
            "~/pause": self._pause,
            "~/step": self._step,
            "~/reset": self._reset,
            "~/spawn": self._each(self._spawn),
            "~/remove": self._each(self._remove),
            "~/set_poses": self._each(self._set_pose),
            "~/get_poses": self._get_poses,
            "~/get_playground": self._get_playground,
        }
        self._services = [
            node.create_service(service.type, name, at_current_tick(simulator, handlers[name]))
            for name, service in SERVICES.items()
        ]
        self._subscription = node.create_subscription(TransformStamped, PLACE_TOPIC, self._place, qos.COMMAND)

    def _pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        self._simulator.pause(bool(request.data))
        response.success, response.message = True, "paused" if self._simulator.paused else "running"
        return response

    def _step(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        if not self._simulator.paused:
            response.success, response.message = False, "the world is running: pause it first"
            return response
        response.success = self._simulator.step()
        now = f"now {self._simulator.world.now_ns / SECOND_NS:.3f} s"
        response.message = now if response.success else f"{now}, where {WORLD_STOPPED}"
        return response

    def _reset(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self._simulator.reset()
        response.success, response.message = True, "world, time and noise are as at the start"
        return response

    def _each(self, act: Callable[[str, ParameterValue], None]) -> Callable[[Any, Any], Any]:
        """A service that does one thing for each name, or says why not."""

        def answer(request: SetParameters.Request, response: SetParameters.Response) -> SetParameters.Response:
            response.results = [self._attempt(act, one.name, one.value) for one in request.parameters]
            self._simulator.update_robots()
            return response

        return answer

    def _attempt(self, act: Callable[[str, ParameterValue], None], name: str, value: Any) -> SetParametersResult:
        try:
            act(name, value)
        except (FieldError, ValueError) as error:
            return SetParametersResult(successful=False, reason=str(error))
        except RuntimeError:  # of parameter_value_to_python
            return SetParametersResult(successful=False, reason=f"{name}: a value of unknown type {value.type} found")
        return SetParametersResult(successful=True)

    def _spawn(self, name: str, value: ParameterValue) -> None:
        x, y, yaw = _pose_of(name, value)
        start = fields.read(RobotStart, {"name": name, "x_m": x, "y_m": y, "yaw_rad": yaw}, "")
        self._simulator.spawn(start)

    def _remove(self, name: str, _value: ParameterValue) -> None:
        world = self._simulator.world
        if name not in world.robots:
            raise ValueError(_unknown(name, tuple(world.robots)))
        world.remove(name)

    def _set_pose(self, name: str, value: ParameterValue) -> None:
        self._move(name, *_pose_of(name, value))

    def _move(self, name: str, x: float, y: float, yaw: float) -> None:
        world = self._simulator.world
        if name in world.robots:
            world.post(name, MoveRobot(x, y, yaw))
        elif name in world.movables:
            world.post(name, MoveObject(x, y, yaw))
        else:
            raise ValueError(_unknown(name, (*world.robots, *world.movables)))

    def _get_poses(self, request: GetParameters.Request, response: GetParameters.Response) -> GetParameters.Response:
        world = self._simulator.world
        poses = {thing.name: thing.pose for thing in world.objects}
        poses |= {name: robot.pose for name, robot in world.robots.items()}
        for name in request.names:
            value = ParameterValue()
            if name in poses:
                pose = poses[name]
                value.type = ParameterType.PARAMETER_DOUBLE_ARRAY
                value.double_array_value = [pose.x_m, pose.y_m, pose.yaw_rad]
            response.values.append(value)
        return response

    def _get_playground(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.success, response.message = True, writer.dumps(self._simulator.world.playground)
        return response

    def _place(self, message: TransformStamped) -> None:
        self._simulator.catch_up()
        try:
            self._place_frame(message)
        except ValueError as error:
            self._simulator.count_refusal()
            self._warn(PLACE_TOPIC, f"refused: {error}")

    def _place_frame(self, message: TransformStamped) -> None:
        """`child_frame_id` is a thing, a robot, or a robot's frame."""
        of_frame = {names.frame("base_link"): robot for robot, names in self._simulator.names.items()}
        maps = {"", *(names.frame("map") for names in self._simulator.names.values())}
        if message.header.frame_id not in maps:
            raise ValueError(f"frame '{message.header.frame_id}' found, expected '{max(maps)}'")
        name, transform = message.child_frame_id, message.transform
        yaw = convert_readings.yaw_of(transform.rotation)
        self._move(of_frame.get(name, name), transform.translation.x, transform.translation.y, yaw)


def _pose_of(name: str, value: ParameterValue) -> tuple[float, float, float]:
    found = parameter_value_to_python(value)
    numbers = [] if found is None or isinstance(found, str | bytes | bool | int | float) else list(found)
    if len(numbers) not in (2, 3) or not all(isinstance(number, int | float) for number in numbers):
        shown = "nothing" if found is None else fields.describe(numbers or found)
        raise ValueError(f"{name}: found {shown}, expected [x, y, yaw] in m and rad")
    x, y, *yaw = map(float, numbers)
    return x, y, yaw[0] if yaw else 0.0


def _unknown(name: str, known: Sequence[str]) -> str:
    return f"nothing here is called '{name}', expected {fields.nearest(name, known)}"
