"""Entity services of simulation_interfaces: list, place, spawn and delete robots, objects and doors."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from typing import Any

from thymio_sim_ros.ros.interface import convert_readings
from thymio_sim_ros.ros.interface.headers import stamp
from thymio_sim_ros.ros.simulator.simulation_interfaces.answers import (
    FAILED,
    NOT_FOUND,
    OK,
    UNSUPPORTED,
    WORLD_FRAMES,
    Act,
    RefusedError,
    resource,
)
from thymio_sim_ros.ros.simulator.world_runner import WorldRunner
from thymio_sim_ros.sim.model import fields
from thymio_sim_ros.sim.model.fields import FieldError
from thymio_sim_ros.sim.playground.placement import PlacementError
from thymio_sim_ros.sim.playground.reader import RobotStart

__all__ = ["SPAWNABLE", "Entities"]

SPAWNABLE = "thymio"
"""URI of the only kind of robot."""
ROBOT, DYNAMIC_OBJECT = 1, 4
"""Values of EntityCategory."""
NAME_NOT_UNIQUE, NAME_INVALID, UNSUPPORTED_FORMAT, NO_RESOURCE, NAMESPACE_INVALID = range(101, 106)
SPAWN_POSE_INVALID, STATE_POSE_INVALID, SOME_FAILED = 109, 101, 150


class Entities:
    """The services on entities."""

    def __init__(self, runner: WorldRunner, map_frame: str, messages: Any) -> None:
        """`messages` is the module `simulation_interfaces.msg`."""
        self._runner, self._map_frame, self._messages = runner, map_frame, messages

    @property
    def acts(self) -> Mapping[str, Act]:
        """Handlers by service name."""
        return {
            "get_entities": self._list,
            "get_entity_info": self._describe,
            "get_entity_state": self._get_state,
            "get_entities_states": self._get_states,
            "set_entity_state": self._set_state,
            "get_spawnables": self._list_spawnables,
            "spawn_entity": self._spawn,
            "spawn_entities": self._spawn_all,
            "delete_entity": self._delete,
        }

    def _categories(self) -> dict[str, int]:
        """Return the category of all entities by name: robots, then objects and doors."""
        world = self._runner.world
        return dict.fromkeys(world.robots, ROBOT) | {thing.name: DYNAMIC_OBJECT for thing in world.objects}

    def _known(self, name: str) -> int:
        categories = self._categories()
        if name not in categories:
            expected = fields.nearest(name, tuple(categories))
            raise RefusedError(NOT_FOUND, f"found unknown name '{name}', expected {expected}")
        return categories[name]

    def _matching(self, filters: Any) -> Iterator[str]:
        if filters.tags.tags:
            raise RefusedError(UNSUPPORTED, "found tags: entities have no tags here")
        if filters.bounds.type:
            raise RefusedError(UNSUPPORTED, "found bounds: filtering by position is not supported")
        try:
            pattern = re.compile(filters.filter)
        except re.error as error:
            raise RefusedError(FAILED, f"filter {filters.filter!r} is no regular expression: {error}") from error
        wanted = {kind.category for kind in filters.categories}
        for name, category in self._categories().items():
            if pattern.search(name) and (not wanted or category in wanted):
                yield name

    def _list(self, request: Any, response: Any) -> None:
        response.entities = list(self._matching(request.filters))

    def _describe(self, request: Any, response: Any) -> None:
        response.info.category.category = category = self._known(request.entity)
        response.info.description = "a Thymio II" if category == ROBOT else "an object or a door"

    def _get_state(self, request: Any, response: Any) -> None:
        self._known(request.entity)
        response.state = self._state(request.entity)

    def _get_states(self, request: Any, response: Any) -> None:
        response.entities = list(self._matching(request.filters))
        response.states = [self._state(name) for name in response.entities]

    def _state(self, name: str) -> Any:
        """Return the true state in the world frame; velocities of objects are not available."""
        world, state = self._runner.world, self._messages.EntityState()
        state.header.stamp, state.header.frame_id = stamp(world.now_ns), self._map_frame
        robot = world.robots.get(name)
        if robot is None:
            pose = next(thing.pose for thing in world.objects if thing.name == name)
            state.pose.orientation = convert_readings.quaternion(pose.yaw_rad)
        else:
            pose, twist = robot.pose, robot.twist
            state.pose.orientation = convert_readings.quaternion(pose.yaw_rad, robot.tilt)
            state.twist.linear.x = twist.linear_m_s * math.cos(pose.yaw_rad)
            state.twist.linear.y = twist.linear_m_s * math.sin(pose.yaw_rad)
            state.twist.angular.z = twist.angular_rad_s
        state.pose.position.x, state.pose.position.y = pose.x_m, pose.y_m
        return state

    def _place(self, header: Any, pose: Any, code: int) -> tuple[float, float, float]:
        """Return x, y and yaw of a pose in the world frame. Raises RefusedError, with `code` for non-finite values."""
        if header.frame_id not in (*WORLD_FRAMES, self._map_frame):
            raise RefusedError(UNSUPPORTED, f"found frame '{header.frame_id}', expected '{self._map_frame}'")
        place = (pose.position.x, pose.position.y, convert_readings.yaw_of(pose.orientation))
        if not all(map(math.isfinite, place)):
            raise RefusedError(code, "the pose has a value that is not finite")
        return place

    def _set_state(self, request: Any, response: Any) -> None:
        name, state, world = request.entity, request.state, self._runner.world
        category = self._known(name)
        speeds = [state.twist.linear, state.twist.angular, state.acceleration.linear, state.acceleration.angular]
        if any(value for vector in speeds for value in (vector.x, vector.y, vector.z)):
            raise RefusedError(UNSUPPORTED, "found velocities: only poses can be set")
        if not getattr(request, "set_pose", True):
            return
        place = self._place(state.header, state.pose, STATE_POSE_INVALID)
        if category != ROBOT and name not in world.movables:
            raise RefusedError(FAILED, f"'{name}' is a door: it cannot be moved")
        try:
            self._runner.move(name, *place)
        except PlacementError as error:
            raise RefusedError(STATE_POSE_INVALID, str(error)) from error

    def _list_spawnables(self, request: Any, response: Any) -> None:
        response.spawnables = [self._messages.Spawnable(uri=SPAWNABLE, description="a Thymio II with all its sensors")]
        if request.sources:
            response.result.error_message = f"unknown sources: {', '.join(request.sources)}"

    def _spawn(self, request: Any, response: Any) -> None:
        uri, text = resource(request, "entity_resource")
        if not uri:
            given = (UNSUPPORTED_FORMAT, "found a text") if text else (NO_RESOURCE, "found no resource")
            raise RefusedError(given[0], f"{given[1]}, expected the URI '{SPAWNABLE}'")
        if uri != SPAWNABLE:
            raise RefusedError(UNSUPPORTED_FORMAT, f"found '{uri}', expected the URI '{SPAWNABLE}'")
        name = self._name(request.name, request.allow_renaming)
        if request.entity_namespace.strip("/") not in ("", name):
            raise RefusedError(
                NAMESPACE_INVALID,
                f"found namespace '{request.entity_namespace}', expected none or the name of the robot",
            )
        header, pose = request.initial_pose.header, request.initial_pose.pose
        x, y, yaw = self._place(header, pose, SPAWN_POSE_INVALID)
        try:
            start = fields.read(RobotStart, {"name": name, "x_m": x, "y_m": y, "yaw_rad": yaw}, "")
            self._runner.spawn(start)
        except FieldError as error:
            raise RefusedError(NAME_INVALID if error.key == "name" else SPAWN_POSE_INVALID, str(error)) from error
        except PlacementError as error:
            raise RefusedError(SPAWN_POSE_INVALID, str(error)) from error
        except ValueError as error:
            raise RefusedError(NAME_NOT_UNIQUE, str(error)) from error
        response.entity_name = name
        self._runner.update_robots()

    def _name(self, wanted: str, allow_renaming: bool) -> str:
        """Return the requested name or, if renaming is allowed and it is taken, the first free one with a number."""
        taken = self._categories()
        if not wanted and not allow_renaming:
            raise RefusedError(NAME_INVALID, "found no name, and renaming is not allowed")
        if wanted and (wanted not in taken or not allow_renaming):
            return wanted
        numbers = range(1 if not wanted else 2, len(taken) + 3)
        return next(name for name in (f"{wanted or SPAWNABLE}_{number}" for number in numbers) if name not in taken)

    def _spawn_all(self, request: Any, response: Any) -> None:
        for spawn in request.spawn_requests:
            result = self._messages.SpawnResult()
            result.result.result = OK
            try:
                self._spawn(spawn, result)
            except RefusedError as refusal:
                result.result.result, result.result.error_message = refusal.code, str(refusal)
            response.results.append(result)
        failed = sum(result.result.result != OK for result in response.results)
        if failed:
            raise RefusedError(SOME_FAILED, f"{failed} of {len(response.results)} were not spawned: see results")

    def _delete(self, request: Any, response: Any) -> None:
        if self._known(request.entity) != ROBOT:
            raise RefusedError(FAILED, f"'{request.entity}' belongs to the playground: only robots can be deleted")
        self._runner.engine.remove(request.entity)
        self._runner.update_robots()
