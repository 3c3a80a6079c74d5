"""The services of the package simulation_interfaces on the node of the simulator, if that package is installed.

Other ROS simulators offer them too (docs/spec/ros-interface.md sections 5 and 7), so their tools can pause, step,
reset, spawn and load here as well. `~/pause` and the other world services do the same with standard types.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from rclpy.node import Node

from thymio_sim_ros.files import resources
from thymio_sim_ros.ros.simulator.parameter_callbacks import ParameterCallbacks
from thymio_sim_ros.ros.simulator.parameters import CurrentParams
from thymio_sim_ros.ros.simulator.simulation_interfaces.answers import (
    FAILED,
    UNSUPPORTED,
    Act,
    Offer,
    RefusedError,
    answering,
    resource,
)
from thymio_sim_ros.ros.simulator.simulation_interfaces.entities import SPAWNABLE, Entities
from thymio_sim_ros.ros.simulator.world_runner import WorldRunner
from thymio_sim_ros.ros.simulator.world_services import WORLD_STOPPED, at_current_tick
from thymio_sim_ros.sim.playground import reader as playgrounds
from thymio_sim_ros.sim.playground.reader import PlaygroundError

__all__ = ["OFFERS", "PACKAGE", "STEPS", "SimInterfaces", "offered"]

PACKAGE = "simulation_interfaces"

OFFERS = (
    Offer("get_simulator_features", "GetSimulatorFeatures", (), "the features below"),
    Offer("get_simulation_state", "GetSimulationState", ("SIMULATION_STATE_GETTING",), "stopped is paused at time 0"),
    Offer(
        "set_simulation_state",
        "SetSimulationState",
        ("SIMULATION_STATE_SETTING", "SIMULATION_STATE_PAUSE"),
        "playing, paused, or stopped, which resets; quitting is rejected",
    ),
    Offer(
        "step_simulation",
        "StepSimulation",
        ("STEP_SIMULATION_SINGLE", "STEP_SIMULATION_MULTIPLE"),
        "execute ticks of 10 ms, at most 100000; rejected unless paused",
    ),
    Offer(
        "reset_simulation",
        "ResetSimulation",
        ("SIMULATION_RESET", "SIMULATION_RESET_TIME", "SIMULATION_RESET_STATE", "SIMULATION_RESET_SPAWNED"),
        "reset everything; scopes cannot be reset separately",
    ),
    Offer("get_entities", "GetEntities", ("ENTITY_CATEGORIES",), "robots, objects, doors; by name and category"),
    Offer("get_entity_info", "GetEntityInfo", ("ENTITY_INFO_GETTING",), "robot or object"),
    Offer("get_entity_state", "GetEntityState", ("ENTITY_STATE_GETTING",), "true pose and velocity in the world frame"),
    Offer("get_entities_states", "GetEntitiesStates", (), "states of several entities"),
    Offer("set_entity_state", "SetEntityState", ("ENTITY_STATE_SETTING",), "set the pose; velocities are rejected"),
    Offer("get_spawnables", "GetSpawnables", ("SPAWNABLES",), f"`{SPAWNABLE}`"),
    Offer("spawn_entity", "SpawnEntity", ("SPAWNING",), f"a robot; its URI is `{SPAWNABLE}`, its namespace its name"),
    Offer("spawn_entities", "SpawnEntities", ("SPAWNING_ENTITIES",), "several, each with a result"),
    Offer("delete_entity", "DeleteEntity", ("DELETING",), "a robot"),
    Offer("get_available_worlds", "GetAvailableWorlds", ("AVAILABLE_WORLDS",), "the shipped playgrounds"),
    Offer(
        "load_world",
        "LoadWorld",
        ("WORLD_LOADING", "WORLD_RESOURCE_STRING"),
        "load a playground by name, path or text; stopped afterwards",
    ),
    Offer("get_current_world", "GetCurrentWorld", ("WORLD_INFO_GETTING",), "the current playground"),
)
"""All services; those whose type is missing in an older version of the package are not offered."""

STEPS = Offer("simulate_steps", "SimulateSteps", ("STEP_SIMULATION_ACTION",), "action: ticks, with feedback after each")

STOPPED, PLAYING, PAUSED = range(3)
"""SimulationState (docs/spec/ros-interface.md section 7)."""
_STATES = ("stopped", "playing", "paused")
ALREADY, INCORRECT_TRANSITION = 101, 103
MAX_STEPS = 100_000
EVERYTHING = (0, 7, 255)
"""Accepted scopes of a reset: none, all flags, all."""
NO_RESOURCE, PARSE_ERROR = 102, 103


class SimInterfaces:
    """The services of one node."""

    def __init__(
        self,
        node: Node,
        runner: WorldRunner,
        params: CurrentParams,
        parameters: ParameterCallbacks,
        interfaces: Any,
    ) -> None:
        """`interfaces` has the modules `msg`, `srv` and optionally `action` of the package."""
        self._runner, self._params, self._parameters = runner, params, parameters
        self._messages = interfaces.msg
        acts = {**self._acts, **Entities(runner, params.values.map_frame, interfaces.msg).acts}
        offers = [offer for offer in OFFERS if hasattr(interfaces.srv, offer.type)]
        self._features = [feature for offer in offers for feature in offer.features]
        for offer in offers:
            answer = self._get_features if offer.name == "get_simulator_features" else answering(acts[offer.name])
            kind = getattr(interfaces.srv, offer.type)
            node.create_service(kind, f"~/{offer.name}", at_current_tick(runner, answer))
        self._close: Callable[[], None] = lambda: None
        actions = getattr(interfaces, "action", None)
        if actions is not None:
            from thymio_sim_ros.ros.simulator.simulation_interfaces.steps import (
                StepsAction,
            )  # imports the action support of rclpy

            self._features += STEPS.features
            self._close = StepsAction(node, runner, actions.SimulateSteps).close

    def close(self) -> None:
        """Close the action server, which the node does not destroy itself."""
        self._close()

    @property
    def _acts(self) -> Mapping[str, Act]:
        return {
            "get_simulation_state": self._get_state,
            "set_simulation_state": self._set_state,
            "step_simulation": self._step,
            "reset_simulation": self._reset,
            "get_available_worlds": self._list_worlds,
            "load_world": self._load_world,
            "get_current_world": self._get_world,
        }

    def _get_features(self, _request: Any, response: Any) -> Any:
        known = self._messages.SimulatorFeatures
        response.features.features = [getattr(known, name) for name in self._features if hasattr(known, name)]
        response.features.spawn_formats = []
        response.features.custom_info = "Thymio Sim ROS: docs/ros.md"
        return response

    # --- time ---

    @property
    def _state(self) -> int:
        if not self._runner.paused:
            return PLAYING
        return PAUSED if self._runner.world.now_ns else STOPPED

    def _get_state(self, _request: Any, response: Any) -> None:
        response.state.state = self._state

    def _set_state(self, request: Any, _response: Any) -> None:
        wanted, now = request.state.state, self._state
        if wanted not in (STOPPED, PLAYING, PAUSED):
            raise RefusedError(UNSUPPORTED, f"found state {wanted}, expected stopped, playing or paused")
        if wanted == now:
            raise RefusedError(ALREADY, f"the simulation is {_STATES[now]} already")
        if (now, wanted) == (STOPPED, PAUSED):
            raise RefusedError(
                INCORRECT_TRANSITION, "the simulation is stopped, which is paused at time 0: step or play it"
            )
        self._runner.pause(wanted != PLAYING)
        if wanted == STOPPED:
            self._runner.reset()

    def _step(self, request: Any, _response: Any) -> None:
        if not self._runner.paused:
            raise RefusedError(FAILED, "the simulation is running: pause it first")
        if request.steps > MAX_STEPS:
            raise RefusedError(
                FAILED, f"found {request.steps} steps, expected at most {MAX_STEPS}; use the action for more"
            )
        if not self._runner.step(request.steps):
            raise RefusedError(FAILED, WORLD_STOPPED)

    def _reset(self, request: Any, _response: Any) -> None:
        if request.scope not in EVERYTHING:
            raise RefusedError(
                UNSUPPORTED, f"found scope {request.scope}, expected 0 or 255: time, state and robots together"
            )
        self._runner.reset()

    # --- worlds ---

    def _world(self, name: str, uri: str, text: str = "", about: str = "") -> Any:
        world = self._messages.WorldResource(name=name, description=about)
        world.world_resource.uri, world.world_resource.resource_string = uri, text
        return world

    def _list_worlds(self, request: Any, response: Any) -> None:
        if request.filter.tags:
            raise RefusedError(UNSUPPORTED, "found tags: worlds have no tags here")
        for name, path in resources.playgrounds().items():
            try:
                about = playgrounds.headline(path).description
            except PlaygroundError:  # already logged at the start
                continue
            response.worlds.append(self._world(name, name, about=about))
        if request.additional_sources:
            response.result.error_message = f"not searched: {', '.join(request.additional_sources)}"

    def _load_world(self, request: Any, response: Any) -> None:
        uri, text = resource(request, "world_resource")
        if not uri and not text:
            raise RefusedError(NO_RESOURCE, "found no resource, expected the name, path or text of a playground")
        reason = self._parameters.load_playground(uri or text)
        if reason:
            raise RefusedError(PARSE_ERROR, reason)
        self._runner.pause(True)
        self._get_world(request, response)

    def _get_world(self, _request: Any, response: Any) -> None:
        name, value = self._runner.prepared.name, self._params.values.playground
        is_name = "\n" not in value and not value.lstrip().startswith(("{", "<"))
        response.world = self._world(name, value if is_name else "", "" if is_name else value)


def offered(
    node: Node, runner: WorldRunner, params: CurrentParams, parameters: ParameterCallbacks
) -> SimInterfaces | None:
    """Create the services if the package is installed; a package that cannot be imported is logged."""
    try:
        import simulation_interfaces.action
        import simulation_interfaces.msg
        import simulation_interfaces.srv
    except ModuleNotFoundError as error:
        if error.name != PACKAGE:
            node.get_logger().warning(f"{PACKAGE} cannot be used: {error}")
        return None
    except ImportError as error:
        node.get_logger().warning(f"{PACKAGE} cannot be used: {error}")
        return None
    return SimInterfaces(node, runner, params, parameters, simulation_interfaces)
