"""The service `~/load`: load a program into one robot or all, and start it (docs/aseba_ros.md names the fields).

Its request and answer have the form of those of `~/check`; what was loaded is then in the parameters of the node.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.node import Node
from rclpy.parameter import Parameter

from thymio_sim_ros.device.behavior_host import MENU
from thymio_sim_ros.ros.aseba.check_service import CheckService, RequestError, refused, values_of

__all__ = ["LoadService"]

_TYPES = dict.fromkeys(("source", "name", "behaviour", "robot", "language"), (Parameter.Type.STRING,))

Load = Callable[[Mapping[str, Any], Collection[str]], SetParametersResult]
"""Sets parameters of the node, and starts the programs of robots."""


class LoadService:
    """The service `~/load`."""

    def __init__(self, node: Node, checker: CheckService, load: Load, *, robots: Callable[[], Sequence[str]]) -> None:
        """`robots` returns the names of the robots."""
        self._checker, self._load, self._robots = checker, load, robots
        node.create_service(SetParametersAtomically, "~/load", self._on_load)

    def _on_load(
        self, request: SetParametersAtomically.Request, response: SetParametersAtomically.Response
    ) -> SetParametersAtomically.Response:
        try:
            given = values_of(request.parameters, _TYPES)
            robot = given.get("robot")
            if robot is not None and robot not in self._robots():
                raise RequestError(f"robot: found '{robot}', expected one of {', '.join(self._robots()) or 'none'}")
            if ("source" in given) == ("behaviour" in given):
                raise RequestError("expected either 'source', the text of a program, or 'behaviour', a built-in one")
            response.result = self._started(given, robot)
        except RequestError as error:
            response.result = refused(str(error))
        return response

    def _started(self, given: Mapping[str, Any], robot: str | None) -> SetParametersResult:
        """Load the program of a request into this robot, or into all. Raises RequestError for wrong values."""
        checked = SetParametersResult(successful=True)
        if "source" in given:
            checked = self._checker.check(given)
            if not checked.successful:
                return checked
        elif given["behaviour"] == MENU:
            robot = None  # from the menu the user starts the other behaviors, on every robot
        robots = self._robots()
        loaded = self._load(_parameters(given, robot, robots), robots if robot is None else [robot])
        return checked if loaded.successful else refused(loaded.reason)


def _parameters(given: Mapping[str, Any], robot: str | None, robots: Sequence[str]) -> dict[str, Any]:
    """Return the parameters of the node for a request; a program for all robots replaces those of single robots."""
    prefix = f"robots.{robot}." if robot else ""
    values: dict[str, Any] = {}
    if not prefix:
        values = {f"robots.{name}.script.{kind}": "" for name in robots if name for kind in ("path", "source")}
    if "source" in given:
        values |= {f"{prefix}script.name": given.get("name", ""), f"{prefix}script.source": given["source"]}
        if not prefix:
            values["behaviour"] = ""
    elif prefix:
        values[f"{prefix}script.path"] = given["behaviour"]
    else:
        values["behaviour"] = given["behaviour"]
    return values
