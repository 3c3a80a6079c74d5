"""Parameters of all nodes, named `/<node>.<parameter>`: a cache that follows /parameter_events, and setting.

The parameters of a node are requested when a client first requests, sets or watches them, not before: a request may
print warnings in the terminal of a node of another project. A rejected value is reported as an error status
`parameter:<name>` before the answer, which always has the current value; the next success removes the status.
A requested parameter that does not exist is reported as a warning of the same name.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain, islice, repeat

from rcl_interfaces.msg import Parameter as RosParameter
from rcl_interfaces.msg import ParameterEvent, ParameterType, ParameterValue, SetParametersResult
from rcl_interfaces.srv import GetParameters, ListParameters, SetParameters
from rclpy.node import Node
from rclpy.qos import qos_profile_parameter_events

from thymio_sim_ros.bridge.protocol.constants import StatusLevel
from thymio_sim_ros.bridge.protocol.messages import Parameter, RemoveStatus, Status, parameter_status
from thymio_sim_ros.bridge.switchboard.events import (
    Command,
    ParametersChanged,
    ParametersRequested,
    ParametersSet,
    ParametersWatched,
    SendParameters,
    SendToClient,
    size_of,
)
from thymio_sim_ros.bridge.switchboard.outcome import MAX_REFUSALS
from thymio_sim_ros.bridge.switchboard.parameters import MAX_WATCHED
from thymio_sim_ros.ros.foxglove.file_access import parameter_refusal
from thymio_sim_ros.ros.foxglove.parameter_values import UnfitValueError, from_ros, to_ros
from thymio_sim_ros.ros.foxglove.service_calls import SET_TIMEOUT_S, ServiceCalls
from thymio_sim_ros.ros.rclpy_ext.parameters import meant, unknown

__all__ = ["Parameters"]

_LIST = "/list_parameters"
_UNDECLARED = "Invalid access to undeclared parameter"
"""Begin of the reason of rclpy for an unknown parameter; the list of names behind it is empty."""
_NOT_OFFERED = "not offered by this bridge"
_PORTION = 8
"""Parameters in one request to a node, so that it can handle other requests in between."""

_FIRST_ANSWER_S = 1.0
"""Longest delay of an answer until nodes have reported their parameters for the first time. Later reports are sent to
clients that watch them."""


@dataclass(slots=True)
class _Change:
    """A request of a client that is being executed: names in their order, reasons of rejections by name."""

    request: ParametersSet
    names: tuple[str, ...]
    refused: dict[str, str] = field(default_factory=dict)
    portions_left: int = 0


@dataclass(slots=True, eq=False)
class _Wait:
    """A function that is called when nodes have answered, or at the deadline."""

    nodes: set[str]
    then: Callable[[], None]
    deadline_s: float


class Parameters:
    """The parameters that clients can get, set and watch.

    Belongs to the executor's thread; `poll` must be called while it returns True.
    """

    def __init__(
        self,
        node: Node,
        calls: ServiceCalls,
        post: Callable[[Command], None],
        *,
        is_allowed: Callable[[str], bool] = lambda name: True,
        wake: Callable[[], None] = lambda: None,
    ) -> None:
        self._calls = calls
        self._post = post
        self._is_allowed = is_allowed
        self._wake = wake
        self._present: set[str] = set()
        """Nodes with parameters."""
        self._wants_all = False
        """Whether a client has requested the parameters of all nodes."""
        self._watched: set[str] = set()
        """Nodes whose parameters clients watch, including nodes that do not exist yet."""
        self._types: dict[str, dict[str, int]] = {}
        """Node whose parameters were requested → parameter → current type code."""
        self._reading: set[str] = set()
        """Nodes that have not answered yet."""
        self._unread: set[str] = set()
        """Nodes that did not answer in time."""
        self._waits: list[_Wait] = []
        self._subscription = node.create_subscription(
            ParameterEvent, "/parameter_events", self._on_event, qos_profile_parameter_events
        )

    def update(self, services: Mapping[str, Sequence[str]]) -> None:
        """Follow the graph: request the parameters of new nodes if clients need them, and remove vanished nodes."""
        self._present = {name.removesuffix(_LIST) for name in services if name.endswith(_LIST)}
        for node in [node for node in self._types if node not in self._present]:
            gone = self._types.pop(node)
            self._unread.discard(node)
            for service in ("list", "get", "set"):
                self._calls.forget(f"{node}/{service}_parameters")
            self._finish_reading(node)
            self._post(ParametersChanged((), tuple(f"{node}.{name}" for name in gone)))
        self._request_parameters(self._present if self._wants_all else self._watched & self._present)

    def refresh(self, *, has_clients: bool) -> None:
        """Repeat requests to nodes that did not answer, such as one that did not spin yet.

        No requests are made while no client is connected (`has_clients` is false).
        """
        if not has_clients:
            self._wants_all = False
            self._watched.clear()
            return
        unread, self._unread = self._unread, set()
        for node in sorted(unread & self._types.keys()):
            self._read_all(node)

    def poll(self) -> bool:
        """Stop waiting for nodes that take too long; return whether functions are waiting."""
        now_s = time.monotonic()
        late = [wait for wait in self._waits if wait.deadline_s <= now_s]
        self._waits = [wait for wait in self._waits if wait.deadline_s > now_s]
        for wait in late:
            wait.then()
        return bool(self._waits)

    def get(self, request: ParametersRequested) -> None:
        """Answer with the current values, after the nodes have reported them."""
        names = request.names or None
        self._wants_all = self._wants_all or names is None
        nodes = self._present if names is None else _nodes_of(names) & self._present

        def answer() -> None:
            self._report_unknown(request)
            self._post(SendParameters(request.client, names, request.request_id))

        self._after(nodes, answer)

    def watch(self, request: ParametersWatched) -> None:
        """Follow the nodes whose parameters a client watches."""
        nodes = _nodes_of(request.names)
        if len(self._watched) <= MAX_WATCHED:
            self._watched |= nodes
        self._request_parameters(nodes & self._present)

    def set(self, request: ParametersSet) -> None:
        """Set values node by node, then answer."""
        names = tuple(item.name for item in request.parameters)
        self._after(_nodes_of(names) & self._present, lambda: self._set(request, names))

    def _request_parameters(self, nodes: Iterable[str]) -> None:
        """Request the parameters of those nodes for which this was never done."""
        for node in sorted(set(nodes) - self._types.keys()):
            self._types[node] = {}
            self._read_all(node)

    def _after(self, nodes: Iterable[str], then: Callable[[], None]) -> None:
        """Call a function as soon as the nodes have answered, after `_FIRST_ANSWER_S` at the latest."""
        nodes = set(nodes)
        self._request_parameters(nodes)
        missing = nodes & self._reading
        if missing:
            self._waits.append(_Wait(missing, then, time.monotonic() + _FIRST_ANSWER_S))
            self._wake()
        else:
            then()

    def _finish_reading(self, node: str) -> None:
        """Call the functions that waited for this node only: it has answered, or will not."""
        self._reading.discard(node)
        ready = []
        for wait in self._waits:
            wait.nodes.discard(node)
            if not wait.nodes:
                ready.append(wait)
        for wait in ready:
            self._waits.remove(wait)
        for wait in ready:
            wait.then()

    def _set(self, request: ParametersSet, names: tuple[str, ...]) -> None:
        change = _Change(request, names)
        by_node: dict[str, list[RosParameter]] = {}
        for parameter in request.parameters:
            node, _, name = parameter.name.partition(".")
            try:
                value = self._checked(parameter, node, name)
            except UnfitValueError as error:
                change.refused[parameter.name] = str(error)
            else:
                by_node.setdefault(node, []).append(RosParameter(name=name, value=value))
        portions = [
            (node, parameters[start : start + _PORTION])
            for node, parameters in by_node.items()
            for start in range(0, len(parameters), _PORTION)
        ]
        change.portions_left = len(portions)
        for node, parameters in portions:
            self._set_on(node, parameters, change)
        if not portions:
            self._answer(change)

    def _checked(self, parameter: Parameter, node: str, name: str) -> ParameterValue:
        if node not in self._types:
            raise UnfitValueError(self._unknown_node(node))
        if not name or not self._is_allowed(parameter.name) or not _is_text(name):
            raise UnfitValueError(_NOT_OFFERED)
        if refusal := parameter_refusal(name, parameter.value):
            raise UnfitValueError(refusal)
        return to_ros(parameter, self._types[node].get(name, ParameterType.PARAMETER_NOT_SET))

    def _set_on(self, node: str, parameters: list[RosParameter], change: _Change) -> None:
        names = [parameter.name for parameter in parameters]

        def was_set(response: SetParameters.Response | None, reason: str) -> None:
            if response is None:
                change.refused.update((f"{node}.{name}", reason) for name in names)
            else:
                missing = SetParametersResult(reason="the node did not report a result")
                for name, result in zip(names, chain(response.results, repeat(missing)), strict=False):
                    if not result.successful:
                        change.refused[f"{node}.{name}"] = self._explained(node, name, result.reason)
            self._read(node, names, lambda: was_read(), sender=change.request.client)

        def was_read() -> None:
            change.portions_left -= 1
            if change.portions_left == 0:
                self._answer(change)

        request = SetParameters.Request(parameters=parameters)
        sender = change.request.client
        self._calls.call(
            SetParameters, f"{node}/set_parameters", request, was_set, sender=sender, timeout_s=SET_TIMEOUT_S
        )

    def _explained(self, node: str, name: str, reason: str) -> str:
        """Return the reason of a node; a sentence of rclpy that does not name the parameter is replaced."""
        if reason.startswith(_UNDECLARED):
            return unknown(name, node, list(self._types.get(node, ())))
        return reason or "rejected by the node"

    def _report_unknown(self, request: ParametersRequested) -> None:
        """Report requested parameters that do not exist, of many only some; the answer has the others."""
        reasons = ((name, self._absence(name)) for name in dict.fromkeys(request.names))
        for name, reason in islice(((name, reason) for name, reason in reasons if reason), MAX_REFUSALS):
            status = Status(StatusLevel.WARNING, f"{name}: {reason}", parameter_status(name))
            self._post(SendToClient(request.client, status))

    def _absence(self, full: str) -> str:
        """Return why a node does not have a parameter; empty if it does, or if the node has not answered yet."""
        node, _, name = full.partition(".")
        if node not in self._types or node in self._reading | self._unread or name in self._types[node]:
            return ""
        return unknown(name, node, list(self._types[node])) if name and self._is_allowed(full) else _NOT_OFFERED

    def _unknown_node(self, node: str) -> str:
        return f"no node {node} with parameters{meant(node, sorted(self._present))}"

    def _answer(self, change: _Change) -> None:
        request = change.request
        accepted = tuple(parameter_status(name) for name in change.names if name not in change.refused)
        if accepted:
            self._post(SendToClient(request.client, RemoveStatus(accepted)))
        refused = list(change.refused.items())
        for name, reason in refused[:MAX_REFUSALS]:
            self._post(
                SendToClient(request.client, Status(StatusLevel.ERROR, f"{name}: {reason}", parameter_status(name)))
            )
        if more := len(refused[MAX_REFUSALS:]):
            self._post(SendToClient(request.client, Status(StatusLevel.ERROR, f"{more} more parameters were rejected")))
        self._post(SendParameters(request.client, change.names, request.request_id, size_of(request)))

    def _read_all(self, node: str) -> None:
        self._reading.add(node)

        def listed(response: ListParameters.Response | None, reason: str) -> None:
            if response is not None:
                self._read(node, response.result.names, lambda: self._finish_reading(node))
            else:
                self._unread.add(node)
                self._finish_reading(node)

        self._calls.call(ListParameters, f"{node}{_LIST}", ListParameters.Request(), listed)

    def _read(
        self, node: str, names: Sequence[str], then: Callable[[], None] = lambda: None, *, sender: int = 0
    ) -> None:
        if node not in self._types:  # ended meanwhile: a call would create its client again
            then()
            return

        def got(response: GetParameters.Response | None, reason: str) -> None:
            if response is not None and len(response.values) == len(names):
                self._update_cache(node, zip(names, response.values, strict=True))
            elif response is not None and len(names) > 1:
                # rclpy returns no values at all if one of the parameters was never set: get them one by one.
                left = list(names)

                def one_more() -> None:
                    left.pop()
                    if not left:
                        then()

                for name in names:
                    self._read(node, [name], one_more, sender=sender)
                return
            elif response is not None:
                self._update_cache(node, [(name, ParameterValue()) for name in names])
            else:
                self._unread.add(node)
            then()

        request = GetParameters.Request(names=names)
        self._calls.call(GetParameters, f"{node}/get_parameters", request, got, sender=sender)

    def _update_cache(self, node: str, values: Iterable[tuple[str, ParameterValue]]) -> None:
        types = self._types.get(node)
        if types is None:  # the node has ended meanwhile
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
        self._update_cache(event.node, items)


def _nodes_of(names: Iterable[str]) -> set[str]:
    return {name.partition(".")[0] for name in names}


def _is_text(name: str) -> bool:
    """Whether ROS can transport the name; surrogate code points cannot be encoded."""
    return name.isprintable()
