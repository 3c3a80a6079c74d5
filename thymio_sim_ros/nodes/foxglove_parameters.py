"""Parameters of all nodes, as `/<node>.<parameter>`: a cache kept fresh by /parameter_events, and setting.

A refused value is told as an error status `parameter:<name>` before the answer, which always carries the value really
in force; the next success removes the status.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import zip_longest
from typing import Any

from rcl_interfaces.msg import Parameter as RosParameter
from rcl_interfaces.msg import ParameterEvent, ParameterType, ParameterValue, SetParametersResult
from rcl_interfaces.srv import GetParameters, ListParameters, SetParameters
from rclpy.node import Node
from rclpy.qos import qos_profile_parameter_events

from thymio_sim_ros.bridge.channels import MAX_REFUSALS
from thymio_sim_ros.bridge.events import Command, ParametersChanged, ParametersSet, ShowParameters, Tell
from thymio_sim_ros.bridge.messages import Parameter, RemoveStatus, Status
from thymio_sim_ros.bridge.vocabulary import StatusLevel
from thymio_sim_ros.nodes.foxglove_calls import Calls
from thymio_sim_ros.nodes.foxglove_files import parameter_refusal
from thymio_sim_ros.nodes.foxglove_values import UnfitValueError, from_ros, to_ros

__all__ = ["Parameters"]

_LIST = "/list_parameters"


@dataclass(slots=True)
class _Change:
    """A client's wish on its way: names in the order of the request, reasons of those that were refused."""

    client: int
    request_id: str | None
    names: tuple[str, ...]
    refused: dict[str, str] = field(default_factory=dict)
    nodes_left: int = 0


class Parameters:
    """Belongs to the executor's thread."""

    def __init__(
        self,
        node: Node,
        calls: Calls,
        post: Callable[[Command], None],
        *,
        is_allowed: Callable[[str], bool] = lambda name: True,
    ) -> None:
        self._calls = calls
        self._post = post
        self._is_allowed = is_allowed
        self._types: dict[str, dict[str, int]] = {}
        """Node → parameter → type code in force."""
        self._unread: set[str] = set()
        """Nodes that did not answer."""
        self._subscription = node.create_subscription(
            ParameterEvent, "/parameter_events", self._on_event, qos_profile_parameter_events
        )

    def update(self, services: Mapping[str, Sequence[str]]) -> None:
        """Ask new nodes for their parameters, forget those of vanished ones."""
        present = {name.removesuffix(_LIST) for name in services if name.endswith(_LIST)}
        for node in [node for node in self._types if node not in present]:
            gone = self._types.pop(node)
            for service in ("list", "get", "set"):
                self._calls.forget(f"{node}/{service}_parameters")
            self._post(ParametersChanged((), tuple(f"{node}.{name}" for name in gone)))
        for node in sorted(present - self._types.keys()):
            self._types[node] = {}
            self._read_all(node)

    def refresh(self) -> None:
        """Ask nodes again that did not answer: one that starts may not spin yet."""
        unread, self._unread = self._unread, set()
        for node in sorted(unread & self._types.keys()):
            self._read_all(node)

    def set(self, wish: ParametersSet) -> None:
        """Set values node by node, then answer."""
        change = _Change(wish.client, wish.request_id, tuple(item.name for item in wish.parameters))
        by_node: dict[str, list[RosParameter]] = {}
        for parameter in wish.parameters:
            node, _, name = parameter.name.partition(".")
            try:
                value = self._checked(parameter, node, name)
            except UnfitValueError as error:
                change.refused[parameter.name] = str(error)
            else:
                by_node.setdefault(node, []).append(RosParameter(name=name, value=value))
        change.nodes_left = len(by_node)
        for node, parameters in by_node.items():
            self._set_on(node, parameters, change)
        if not by_node:
            self._answer(change)

    def _checked(self, parameter: Parameter, node: str, name: str) -> ParameterValue:
        if node not in self._types:
            raise UnfitValueError(f"no node {node} with parameters")
        if not name or not self._is_allowed(parameter.name) or not _is_text(name):
            raise UnfitValueError("not offered by this bridge")
        if refusal := parameter_refusal(name, parameter.value):
            raise UnfitValueError(refusal)
        return to_ros(parameter, self._types[node].get(name, ParameterType.PARAMETER_NOT_SET))

    def _set_on(self, node: str, parameters: list[RosParameter], change: _Change) -> None:
        names = [parameter.name for parameter in parameters]

        def was_set(response: Any, reason: str) -> None:
            if response is None:
                change.refused.update((f"{node}.{name}", reason) for name in names)
            else:
                missing = SetParametersResult(reason="the node did not say what became of it")
                for name, result in zip_longest(names, response.results[: len(names)], fillvalue=missing):
                    if not result.successful:
                        change.refused[f"{node}.{name}"] = result.reason or "refused by the node"
            self._read(node, names, lambda: was_read())

        def was_read() -> None:
            change.nodes_left -= 1
            if change.nodes_left == 0:
                self._answer(change)

        request = SetParameters.Request(parameters=parameters)
        self._calls.call(SetParameters, f"{node}/set_parameters", request, was_set)

    def _answer(self, change: _Change) -> None:
        accepted = tuple(_status_id(name) for name in change.names if name not in change.refused)
        if accepted:
            self._post(Tell(change.client, RemoveStatus(accepted)))
        refused = list(change.refused.items())
        for name, reason in refused[:MAX_REFUSALS]:
            self._post(Tell(change.client, Status(StatusLevel.ERROR, f"{name}: {reason}", _status_id(name))))
        if more := len(refused[MAX_REFUSALS:]):
            self._post(Tell(change.client, Status(StatusLevel.ERROR, f"{more} more parameters were refused")))
        self._post(ShowParameters(change.client, change.names, change.request_id))

    def _read_all(self, node: str) -> None:
        def listed(response: Any, reason: str) -> None:
            if response is not None:
                self._read(node, response.result.names)
            else:
                self._unread.add(node)

        self._calls.call(ListParameters, f"{node}{_LIST}", ListParameters.Request(), listed)

    def _read(self, node: str, names: Sequence[str], then: Callable[[], None] = lambda: None) -> None:
        def got(response: Any, reason: str) -> None:
            if response is not None and len(response.values) == len(names):
                self._learn(node, zip(names, response.values, strict=True))
            elif response is not None and len(names) > 1:
                # rclpy gives no value at all where one of them was declared and never set.
                left = list(names)

                def one_more() -> None:
                    left.pop()
                    if not left:
                        then()

                for name in names:
                    self._read(node, [name], one_more)
                return
            elif response is not None:
                self._learn(node, [(name, ParameterValue()) for name in names])
            else:
                self._unread.add(node)
            then()

        self._calls.call(GetParameters, f"{node}/get_parameters", GetParameters.Request(names=names), got)

    def _learn(self, node: str, values: Iterable[tuple[str, ParameterValue]]) -> None:
        types = self._types.get(node)
        if types is None:  # vanished meanwhile
            return
        changed, removed = [], []
        for name, value in values:
            full = f"{node}.{name}"
            if not self._is_allowed(full):
                continue
            if value.type == ParameterType.PARAMETER_NOT_SET:
                types.pop(name, None)
                removed.append(full)
            else:
                types[name] = value.type
                changed.append(from_ros(full, value))
        self._post(ParametersChanged(tuple(changed), tuple(removed)))

    def _on_event(self, event: ParameterEvent) -> None:
        items = [(item.name, item.value) for item in (*event.new_parameters, *event.changed_parameters)]
        items += [(item.name, ParameterValue()) for item in event.deleted_parameters]
        self._learn(event.node, items)


def _is_text(name: str) -> bool:
    """Whether ROS can carry it: halves of characters cannot be."""
    return name.isprintable()


def _status_id(name: str) -> str:
    return f"parameter:{name}"
