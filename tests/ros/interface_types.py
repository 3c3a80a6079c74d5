"""The types of simulation_interfaces: those of the package where it is installed, else plain ones with their fields.

The package is in no wheel; what its services do is tested all the same.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

from geometry_msgs.msg import Accel, Pose, PoseStamped, Twist
from std_msgs.msg import Header


def _kind(name: str, /, **fields: Callable[[], Any]) -> Any:
    """A class with these fields alone, each with what makes its default."""
    members = [(field, Any, dataclasses.field(default_factory=make)) for field, make in fields.items()]
    return dataclasses.make_dataclass(name, members, slots=True)


def _service(request: dict[str, Callable[[], Any]], response: dict[str, Callable[[], Any]]) -> Any:
    return SimpleNamespace(Request=_kind("Request", **request), Response=_kind("Response", result=Result, **response))


Result = _kind("Result", result=int, error_message=str)
TagsFilter = _kind("TagsFilter", tags=list, filter_mode=int)
Bounds = _kind("Bounds", type=int, points=list)
EntityCategory = _kind("EntityCategory", category=int)
EntityFilters = _kind("EntityFilters", filter=str, categories=list, tags=TagsFilter, bounds=Bounds)
EntityInfo = _kind("EntityInfo", category=EntityCategory, description=str, tags=list)
EntityState = _kind("EntityState", header=Header, pose=Pose, twist=Twist, acceleration=Accel)
Resource = _kind("Resource", uri=str, resource_string=str)
WorldResource = _kind("WorldResource", name=str, world_resource=Resource, description=str, tags=list)
SimulationState = _kind("SimulationState", state=int)
Features = _kind("SimulatorFeatures", features=list, spawn_formats=list, custom_info=str)
SpawnResult = _kind("SpawnResult", result=Result, entity_name=str)
Spawnable = _kind("Spawnable", uri=str, description=str, spawn_bounds=Bounds)

for number, feature in enumerate(("SPAWNING", "DELETING")):
    setattr(Features, feature, number)
Features.ENTITY_STATE_GETTING, Features.STEP_SIMULATION_MULTIPLE = 10, 32

_SPAWN = {
    "name": str,
    "allow_renaming": bool,
    "uri": str,
    "resource_string": str,
    "entity_namespace": str,
    "initial_pose": PoseStamped,
}
SpawnEntity = _kind("SpawnEntity", **_SPAWN)

_MESSAGES = SimpleNamespace(
    EntityState=EntityState,
    EntityCategory=EntityCategory,
    SimulationState=SimulationState,
    SimulatorFeatures=Features,
    Spawnable=Spawnable,
    SpawnEntity=SpawnEntity,
    SpawnResult=SpawnResult,
    WorldResource=WorldResource,
)
_SERVICES = SimpleNamespace(
    GetSimulatorFeatures=_service({}, {"features": Features}),
    GetSimulationState=_service({}, {"state": SimulationState}),
    SetSimulationState=_service({"state": SimulationState}, {}),
    StepSimulation=_service({"steps": lambda: 1}, {}),
    ResetSimulation=_service({"scope": int}, {}),
    GetEntities=_service({"filters": EntityFilters}, {"entities": list}),
    GetEntityInfo=_service({"entity": str}, {"info": EntityInfo}),
    GetEntityState=_service({"entity": str}, {"state": EntityState}),
    GetEntitiesStates=_service({"filters": EntityFilters}, {"entities": list, "states": list}),
    SetEntityState=_service({"entity": str, "state": EntityState}, {}),
    GetSpawnables=_service({"sources": list}, {"spawnables": list}),
    SpawnEntity=_service(_SPAWN, {"entity_name": str}),
    SpawnEntities=_service({"spawn_requests": list}, {"results": list}),
    DeleteEntity=_service({"entity": str}, {}),
    GetAvailableWorlds=_service(
        {"additional_sources": list, "filter": TagsFilter, "offline_only": bool, "continue_on_error": bool},
        {"worlds": list},
    ),
    LoadWorld=_service({"uri": str, "resource_string": str}, {"world": WorldResource}),
    GetCurrentWorld=_service({}, {"world": WorldResource}),
)


def interfaces() -> Any:
    """Its modules `msg` and `srv`."""
    try:
        import simulation_interfaces.msg
        import simulation_interfaces.srv
    except ImportError:
        return SimpleNamespace(msg=_MESSAGES, srv=_SERVICES)
    return SimpleNamespace(msg=simulation_interfaces.msg, srv=simulation_interfaces.srv)
