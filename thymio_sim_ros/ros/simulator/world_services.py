"""Services and topics that control time and world (docs/ros.md).

Robots are added, removed and moved by services of `rcl_interfaces`: among the standard types only these carry names
with values and return a reason for each. A topic moves robots and objects that a viewer drags.
"""

from __future__ import annotations

import base64
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeVar

from geometry_msgs.msg import TransformStamped
from rcl_interfaces.msg import ParameterType, ParameterValue, SetParametersResult
from rcl_interfaces.srv import GetParameters, SetParameters
from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python
from std_srvs.srv import SetBool, Trigger

from thymio_sim_ros.missions import MissionError
from thymio_sim_ros.ros.interface import convert_readings, qos
from thymio_sim_ros.ros.interface.headers import SECOND_NS
from thymio_sim_ros.ros.rclpy_ext.local_node import LocalNode
from thymio_sim_ros.ros.rclpy_ext.message_reports import MessageReports
from thymio_sim_ros.ros.simulator.mission_endpoints import MissionEndpoints
from thymio_sim_ros.ros.simulator.recording import MAX_KEPT_BYTES
from thymio_sim_ros.ros.simulator.robot_endpoint_set import RobotEndpointSet
from thymio_sim_ros.ros.simulator.world_runner import WorldRunner
from thymio_sim_ros.sim.model import fields
from thymio_sim_ros.sim.model.fields import FieldError
from thymio_sim_ros.sim.playground import writer
from thymio_sim_ros.sim.playground.drawings import drawings
from thymio_sim_ros.sim.playground.reader import RobotStart

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Service as ServiceType

__all__ = ["PLACE_MEANING", "PLACE_TOPIC", "SERVICES", "WorldServices", "at_current_tick"]


@dataclass(frozen=True, slots=True)
class Service:
    """Type and description of a service."""

    type: type[ServiceType[Any, Any]]
    about: str


SERVICES: Mapping[str, Service] = {
    "~/pause": Service(SetBool, "true: pause, false: resume"),
    "~/step": Service(Trigger, "execute `step_ticks` ticks of 10 ms; rejected unless paused"),
    "~/reset": Service(Trigger, "reset world, time and noise to the start; `/clock` goes back to 0"),
    "~/spawn": Service(SetParameters, "add robots: name → [x, y, yaw] in m and rad, yaw is optional"),
    "~/remove": Service(SetParameters, "remove robots: names; values are ignored"),
    "~/set_poses": Service(SetParameters, "move robots and objects: name → [x, y, yaw]"),
    "~/get_poses": Service(
        GetParameters, "poses of robots, objects and doors: names → [x, y, yaw]; NOT_SET for unknown names"
    ),
    "~/get_primitives": Service(
        SetParameters,
        "any name → a JSON list of shapes as in a playground file, without names; `reason`: a JSON list with the"
        " `primitives` of each, or its `fault` with `key`, `found`, `expected`, `word`",
    ),
    "~/get_playground": Service(Trigger, "`message` is the playground as JSON, with its images"),
    "~/get_run_log": Service(
        Trigger, "`message` is the log of the run since its last reset, gzip in base64, for `thymio-sim replay`"
    ),
    "~/start_mission": Service(
        SetParameters,
        "load the playground of a mission and judge its tries: name of a shipped mission; for another one, any name → "
        "its file as a data URL",
    ),
    "~/check_mission": Service(
        SetParameters,
        "run the solutions of a mission, but no nodes: any name → its file as a data URL; `reason`: JSON with those "
        "that do not get all stars, language → a boolean for each star",
    ),
    "~/end_mission": Service(Trigger, "judge no more; the playground stays"),
}
"""All services of the simulator for the world as a whole."""

PLACE_TOPIC = "~/_place"
"""The topic with the effect of `~/set_poses`, for viewers that drag."""

WORLD_STOPPED = "the world stopped with an internal error (please report): see the log of the simulator"
PLACE_MEANING = "move a robot or an object: `child_frame_id` is its name, or the frame of a robot"


Handler = Callable[[Any, Any], Any]

Q = TypeVar("Q")
R = TypeVar("R")


def at_current_tick(runner: WorldRunner, handler: Callable[[Q, R], R]) -> Callable[[Q, R], R]:
    """Wrap a service handler so that deferred ticks are executed first."""

    def handle(request: Q, response: R) -> R:
        runner.catch_up()
        return handler(request, response)

    return handle


class WorldServices:
    """The world services on the node of the simulator."""

    def __init__(
        self,
        node: Node | LocalNode,
        runner: WorldRunner,
        robots: RobotEndpointSet,
        messages: MessageReports,
        missions: MissionEndpoints,
    ) -> None:
        self._runner, self._robots, self._messages, self._missions = runner, robots, messages, missions
        handlers: dict[str, Handler] = {
            "~/pause": self._pause,
            "~/step": self._step,
            "~/reset": self._reset,
            "~/spawn": self._each(self._spawn),
            "~/remove": self._each(self._remove),
            "~/set_poses": self._each(self._set_pose),
            "~/get_poses": self._get_poses,
            "~/get_primitives": self._each(self._get_primitives),
            "~/get_playground": self._get_playground,
            "~/get_run_log": self._get_run_log,
            "~/start_mission": self._each(lambda name, value: self._missions.start(name, value.string_value)),
            "~/check_mission": self._each(lambda name, value: self._missions.check(name, value.string_value)),
            "~/end_mission": self._end_mission,
        }
        self._services = [
            node.create_service(service.type, name, at_current_tick(runner, handlers[name]))
            for name, service in SERVICES.items()
        ]
        self._subscription = node.create_subscription(TransformStamped, PLACE_TOPIC, self._place, qos.COMMAND)

    def _pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        self._runner.pause(bool(request.data))
        response.success, response.message = True, "paused" if self._runner.paused else "running"
        return response

    def _step(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        if not self._runner.paused:
            response.success, response.message = False, "the simulation is running: pause it first"
            return response
        response.success = self._runner.step()
        now = f"now {self._runner.world.now_ns / SECOND_NS:.3f} s"
        response.message = now if response.success else f"{now}: {WORLD_STOPPED}"
        return response

    def _reset(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self._runner.reset()
        response.success, response.message = True, "world, time and noise were reset"
        return response

    def _each(
        self, act: Callable[[str, ParameterValue], str | None]
    ) -> Callable[[SetParameters.Request, SetParameters.Response], SetParameters.Response]:
        """Return a service handler that applies `act` to each name: its answer, or the reason where it fails."""

        def answer(request: SetParameters.Request, response: SetParameters.Response) -> SetParameters.Response:
            response.results = [self._attempt(act, parameter.name, parameter.value) for parameter in request.parameters]
            self._runner.update_robots()
            return response

        return answer

    def _attempt(
        self, act: Callable[[str, ParameterValue], str | None], name: str, value: ParameterValue
    ) -> SetParametersResult:
        try:
            answer = act(name, value)
        except (FieldError, MissionError, ValueError, InterruptedError) as error:
            return SetParametersResult(successful=False, reason=str(error))
        except RuntimeError:  # raised by parameter_value_to_python
            return SetParametersResult(successful=False, reason=f"{name}: found a value of unknown type {value.type}")
        return SetParametersResult(successful=True, reason=answer or "")

    def _spawn(self, name: str, value: ParameterValue) -> None:
        x, y, yaw = _pose_of(name, value)
        start = fields.read(RobotStart, {"name": name, "x_m": x, "y_m": y, "yaw_rad": yaw}, "")
        self._runner.spawn(start)

    def _remove(self, name: str, _value: ParameterValue) -> None:
        world = self._runner.world
        if name not in world.robots:
            raise ValueError(_unknown(name, tuple(world.robots)))
        self._runner.engine.remove(name)

    def _set_pose(self, name: str, value: ParameterValue) -> None:
        self._move(name, *_pose_of(name, value))

    def _move(self, name: str, x: float, y: float, yaw: float) -> None:
        world = self._runner.world
        if name not in world.robots and name not in world.movables:
            raise ValueError(_unknown(name, (*world.robots, *world.movables)))
        self._runner.move(name, x, y, yaw)

    def _get_poses(self, request: GetParameters.Request, response: GetParameters.Response) -> GetParameters.Response:
        world = self._runner.world
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

    def _get_primitives(self, _name: str, value: ParameterValue) -> str:
        return self._runner.run_beside(lambda: drawings(value.string_value))

    def _get_run_log(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        log = self._runner.run_log()
        response.success = log is not None
        too_large = f"the run is larger than {MAX_KEPT_BYTES / 1e6:g} MB; a reset begins a new one, or start with --log"
        response.message = too_large if log is None else base64.b64encode(log).decode("ascii")
        return response

    def _end_mission(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self._missions.end()
        response.success = True
        return response

    def _get_playground(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.success, response.message = True, writer.dumps(self._runner.world.playground)
        return response

    def _place(self, message: TransformStamped) -> None:
        self._runner.catch_up()
        try:
            self._place_frame(message)
        except ValueError as error:
            self._messages.add_rejected(PLACE_TOPIC, error)

    def _place_frame(self, message: TransformStamped) -> None:
        """Move an object or robot; `child_frame_id` is its name or a robot's frame."""
        robots = self._robots.names
        of_frame = {names.frame("base_link"): robot for robot, names in robots.items()}
        maps = {"", *(names.frame("map") for names in robots.values())}
        if message.header.frame_id not in maps:
            raise ValueError(f"found frame '{message.header.frame_id}', expected '{max(maps)}'")
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
    return f"found unknown name '{name}', expected {fields.nearest(name, known)}"
