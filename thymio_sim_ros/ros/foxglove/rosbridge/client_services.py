"""Services and actions that a client calls and serves."""

from __future__ import annotations

import itertools
from functools import partial
from math import inf
from typing import TYPE_CHECKING, Any

from thymio_sim_ros.bridge.rosbridge.frames import Operation
from thymio_sim_ros.bridge.switchboard.pending_requests import MAX_PENDING_CALLS
from thymio_sim_ros.ros.foxglove.file_access import call_refusal
from thymio_sim_ros.ros.foxglove.rosbridge import rosapi
from thymio_sim_ros.ros.foxglove.rosbridge.client_node import ClientNode
from thymio_sim_ros.ros.foxglove.rosbridge.client_topics import Key, key_of
from thymio_sim_ros.ros.foxglove.rosbridge.goals import Goals
from thymio_sim_ros.ros.foxglove.rosbridge.host import Host, RefusedError
from thymio_sim_ros.ros.foxglove.rosbridge.outbox import Outbox
from thymio_sim_ros.ros.foxglove.rosbridge.served import ServedService
from thymio_sim_ros.ros.foxglove.rosbridge.served_actions import ServedAction
from thymio_sim_ros.ros.foxglove.rosbridge.values import Compression, ValueRefusedError, from_message, to_message
from thymio_sim_ros.ros.foxglove.service_calls import CALL_TIMEOUT_S
from thymio_sim_ros.ros.foxglove.types import MissingTypeError, full_name, load_type

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message

__all__ = ["ClientServices"]


class ClientServices:
    """The calls of one client, and the services and actions that it serves."""

    def __init__(self, host: Host, outbox: Outbox, client: int) -> None:
        self._host, self._outbox, self._client = host, outbox, client
        self._served: dict[Key, ServedService] = {}
        self._actions: dict[Key, ServedAction] = {}
        self._numbers = itertools.count(1)
        """Numbers of the requests and goals that the client gets."""
        self._calls = 0
        """Calls without an answer."""
        self.goals = Goals(host, outbox)

    def __len__(self) -> int:
        return len(self._served) + len(self._actions)

    # --- calls ---

    def call(self, operation: Operation, place: ClientNode) -> None:
        """Call a service. The answer says why a call fails, and so does a status."""
        try:
            self._call(operation, place)
        except (RefusedError, ValueRefusedError) as error:
            self._fail(operation, str(error))

    def _call(self, operation: Operation, place: ClientNode) -> None:
        name = place.resolve(operation["service"].partition("#")[0], "call_service.service")
        if not self._host.is_service(name):
            raise RefusedError(f"call_service.service: {name} is not offered (service_whitelist)")
        if self._calls >= MAX_PENDING_CALLS:
            raise RefusedError(f"call_service: {MAX_PENDING_CALLS} calls of this client are pending")
        if rosapi.serves(name) and not self._host.node.count_services(name):
            self._calls += 1
            rosapi.call(self._host, name, operation.get("args"), partial(self._answer, operation), self._client)
            return
        type_name, kind = self._host.service_type(name, operation.get("type"), "call_service.service")
        request = to_message(_named(operation.get("args"), kind.Request), kind.Request, "call_service.args")
        if refusal := call_refusal(type_name, request):
            raise RefusedError(f"{name}: {refusal}")
        compression = Compression(operation.get("compression", "none"))

        def done(response: Message | None, reason: str) -> None:
            self._answer(operation, reason if response is None else from_message(response, compression))

        self._calls += 1
        timeout_s = operation.get("timeout", CALL_TIMEOUT_S) or inf
        self._host.calls.call(kind, name, request, done, sender=self._client, timeout_s=timeout_s)

    def _answer(self, operation: Operation, values: dict[str, Any] | str) -> None:
        """Answer a call with the fields of the response, or with the reason why there is none."""
        self._calls -= 1
        if isinstance(values, str):
            self._fail(operation, values)
        else:
            self._outbox.answer("service_response", "service", operation, values=values, result=True)

    def _fail(self, operation: Operation, reason: str) -> None:
        self._outbox.status("error", reason, operation.get("id"))
        self._outbox.answer("service_response", "service", operation, values=reason, result=False)

    # --- served services and actions ---

    def advertise(self, operation: Operation, place: ClientNode) -> None:
        """Serve a service. Raises RefusedError."""
        name = place.resolve(operation["service"], "advertise_service.service")
        type_name, kind = self._host.service_type(name, operation["type"], "advertise_service.type")
        key = key_of(operation, "service")
        if key in self._served:
            self._end(self._served, key)
        compression = Compression(operation.get("compression", "none"))
        self._served[key] = ServedService(
            self._outbox, place, name, kind, compression, _shown(operation, "service", key), self._numbers
        )
        self._host.served[name] = type_name

    def unadvertise(self, operation: Operation) -> None:
        """End a served service. Raises RefusedError."""
        self._of(self._served, operation, "service")
        self._end(self._served, key_of(operation, "service"))

    def respond(self, operation: Operation) -> None:
        """Answer a request. Raises RefusedError or ValueRefusedError."""
        request_id = str(operation["id"])
        served = next((item for item in self._served.values() if item.has(request_id)), None)
        if served is None:
            raise RefusedError(f"service_response.id: expected the id of a request, found {request_id}")
        served.respond(operation)

    def advertise_action(self, operation: Operation, place: ClientNode) -> None:
        """Serve an action. Raises RefusedError."""
        action = place.resolve(operation["action"], "advertise_action.action")
        type_name = full_name(operation["type"], "action")
        try:
            kind = load_type(type_name)
        except MissingTypeError as error:
            raise RefusedError(f"advertise_action.type: {error}") from error
        if not hasattr(kind, "Goal"):
            raise RefusedError(f"advertise_action.type: expected an action, found {type_name}")
        key = key_of(operation, "action")
        if key in self._actions:
            self._end(self._actions, key)
        shown = _shown(operation, "action", key) | {"action_type": type_name}
        self._actions[key] = ServedAction(self._outbox, place, action, kind, shown, self._numbers)

    def unadvertise_action(self, operation: Operation) -> None:
        """End a served action. Raises RefusedError."""
        self._of(self._actions, operation, "action")
        self._end(self._actions, key_of(operation, "action"))

    def action_of(self, operation: Operation) -> ServedAction:
        """The served action that an operation is about. Raises RefusedError."""
        goal_id = str(operation["id"])
        found = next((item for item in self._actions.values() if item.has(goal_id)), None)
        if found is None:
            raise RefusedError(f"{operation['op']}.id: expected the id of a goal, found {goal_id}")
        return found

    @staticmethod
    def _of(served: dict[Key, Any], operation: Operation, name: str) -> Any:
        found = served.get(key_of(operation, name))
        if found is None:
            raise RefusedError(f"{operation['op']}.{name}: expected an advertised one, found {operation[name]:.80}")
        return found

    def _end(self, served: dict[Key, Any], key: Key) -> None:
        ended = served.pop(key)
        ended.close()
        if isinstance(ended, ServedService):
            self._host.served.pop(ended.service, None)

    def close(self, node: str | None = None) -> None:
        """End what a node of the client serves, None: everything, also its goals."""
        for served in (self._served, self._actions):
            for key in [key for key in served if node in (None, key[0])]:
                self._end(served, key)
        if node is None:
            self.goals.close()
            self._host.calls.cancel(self._client)


def _shown(operation: Operation, name: str, key: Key) -> dict[str, Any]:
    """How the client knows what it serves; requests with an ID of their own carry that of the service as `served`."""
    return {name: operation[name], **({"node": key[0], "served": key[2]} if key[0] else {})}


def _named(args: object, kind: type[Message]) -> object:
    """Arguments by name, where a client gives them in the order of the fields."""
    return dict(zip(kind.get_fields_and_field_types(), args, strict=False)) if isinstance(args, list) else args
