"""One connection with a rosbridge server, without I/O: operations from the graph of this process, and to it."""

from __future__ import annotations

import itertools
import time
import weakref
from collections import deque
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from thymio_sim_ros.portable_ros.graph.graph import Graph
from thymio_sim_ros.portable_ros.graph.protocols import PublisherEnd, Sample
from thymio_sim_ros.portable_ros.graph.remote_ends import Kind
from thymio_sim_ros.portable_ros.rosbridge.descriptions import NodeDescription, read_graph
from thymio_sim_ros.portable_ros.rosbridge.local_endpoints import Announcements, LocalEndpoint
from thymio_sim_ros.portable_ros.rosbridge.operations import Operation, OperationError, decode, encode, field
from thymio_sim_ros.portable_ros.rosbridge.outbox import Outbox
from thymio_sim_ros.portable_ros.rosbridge.payloads import JsonCodec, Payloads
from thymio_sim_ros.portable_ros.rosbridge.remote_graph import RemoteGraph
from thymio_sim_ros.portable_ros.rosbridge.rosapi import RosapiPoll
from thymio_sim_ros.portable_ros.rosbridge.service_calls import ServiceCalls

__all__ = ["FOREIGN", "NO_ROSAPI", "Session"]

FOREIGN = (
    "the server knows no nodes: this program appears as a part of the server's node, without parameters in"
    " `ros2 param list`; of QoS only depth and transient local publishers are carried"
)
NO_ROSAPI = (
    "the server has no node `rosapi`, so that its nodes, topics and services are not known and no service is found;"
    " start rosbridge with its launch file"
)
_GRAPH = "graph"
ACTION_PART = "/_action/"
"""Within the names of the services and topics of an action."""
_MOST_REPORTS = 100
"""Different reports of a connection."""


class _Publication(NamedTuple):
    topic: str
    type_name: str
    sample: Sample


class Session:
    """What has been agreed with a server since the connection was made.

    `frames` and `receive` are for the thread of the connection, `publish` for all threads.
    """

    def __init__(
        self,
        graph: Graph,
        codec: JsonCodec,
        wake: Callable[[], None],
        report: Callable[[str], None],
    ) -> None:
        """`wake` has `frames` called soon; `report` gets lines for the user."""
        self._graph, self._wake, self._report = graph, wake, report
        self._remote = RemoteGraph(graph, lambda *call: self._calls.call(*call))
        self._outbox: Outbox[_Publication | Operation] = Outbox()
        self._greetings: deque[Operation] = deque([{"op": _GRAPH, "id": _GRAPH}])
        self._payloads = Payloads(codec)
        self._calls = ServiceCalls(self._payloads, self._queue, self._report_once)
        self._announcements: Announcements | None = None
        self._is_changed = True
        self._is_removal_due = False
        self._sent: weakref.WeakKeyDictionary[Any, int] = weakref.WeakKeyDictionary()
        """Publisher → the sequence number of its last message that was sent."""
        self._received = itertools.count(1)
        self._poll: RosapiPoll | None = None
        self._service_types: dict[str, str] = {}
        self._has_rosapi = True
        self._reported: set[str] = set()
        self._start_poll()

    @property
    def is_ready(self) -> bool:
        """Whether the remote graph is known and messages are carried."""
        return self._announcements is not None

    @property
    def needs_polls(self) -> bool:
        """Whether changes of the remote graph are only found by `poll`."""
        return self.is_ready and self._has_rosapi and not self._payloads.is_serialized

    def poll(self) -> None:
        """Ask for the remote graph, unless an earlier question is not answered."""
        if self._poll is None:
            self._start_poll()

    def end(self) -> None:
        """Remove the remote nodes, and drop what has not been sent."""
        self._announcements = None
        self._outbox.clear()
        self._remote.update(())

    def graph_changed(self) -> None:
        """Note that there are new nodes or endpoints, or that some are gone."""
        self._is_changed = True
        self._wake()

    def publish(self, publisher: PublisherEnd, sample: Sample) -> bool:
        """Queue a message of a publisher; return whether there is a server that gets it."""
        if not self.is_ready:
            return False
        item = _Publication(publisher.topic_name, publisher.msg_type.TYPE_NAME, sample)
        self._outbox.put(publisher, item, publisher.qos_profile.kept)
        self._wake()
        return True

    def frames(self) -> Iterator[str | bytes]:
        """All that is to be sent now. Endpoints are announced before their messages."""
        while True:
            while self._greetings:
                yield encode(self._greetings.popleft(), is_binary=False)
            if self._announcements is None:
                return
            if self._is_changed:
                self._is_changed, self._is_removal_due = False, True
                yield from self._announce(self._announcements)
            found = self._outbox.take()
            if found is None:
                yield from self._remove(self._announcements)
                return
            sender, item = found
            operation = self._publication(sender, item) if isinstance(item, _Publication) else item
            if operation is not None:
                yield encode(operation, is_binary=self._payloads.is_serialized)

    def receive(self, frame: str | bytes) -> None:
        """Take a frame of the server; wrong ones are reported."""
        try:
            operation = decode(frame)
            handlers: dict[str, Callable[[Operation], None]] = {
                "publish": self._receive_message,
                "call_service": self._receive_request,
                "service_response": self._receive_response,
                "status": self._receive_status,
                _GRAPH: self._receive_graph,
                "node": _ignore,
            }
            handler = handlers.get(operation["op"])
            if handler is None:
                raise OperationError(f"found operation {operation['op']!r:.60}, which this program does not know")
            handler(operation)
        except OperationError as error:
            self._report_once(f"the server sent what it should not: {error}")

    def _announce(self, announcements: Announcements) -> Iterator[str | bytes]:
        for operation, endpoint in announcements.added():
            if endpoint is not None:
                self._report_limits(endpoint)
            yield encode(operation, is_binary=False)
            if endpoint is None:
                continue
            if endpoint.kind is Kind.PUBLISHER:
                for sample in endpoint.end.retained:
                    item = _Publication(endpoint.name, endpoint.type_name, sample)
                    if (again := self._publication(endpoint.end, item)) is not None:
                        yield encode(again, is_binary=self._payloads.is_serialized)

    def _remove(self, announcements: Announcements) -> Iterator[str | bytes]:
        if self._is_removal_due:
            self._is_removal_due = False
            for operation in announcements.removed():
                yield encode(operation, is_binary=False)

    def _publication(self, publisher: Any, item: _Publication) -> Operation | None:
        """The operation for a message; None if it has been sent, as one that was retained."""
        if item.sample.sequence_number <= self._sent.get(publisher, 0):
            return None
        self._sent[publisher] = item.sample.sequence_number
        operation: Operation = {"op": "publish", "topic": item.topic}
        if self._announcements is not None:
            operation |= self._announcements.place_of(publisher)
        operation["msg"] = self._payloads.outgoing(item.sample.data, item.type_name)
        return operation

    def _queue(self, sender: object, operation: Operation) -> None:
        if not self._outbox.put(sender, operation, None):
            self._report_once("the connection is too slow: requests or responses were dropped")
        self._wake()

    def _receive_message(self, operation: Operation) -> None:
        topic = field(operation, "topic", str)
        announcements = self._ready()
        found = announcements.endpoint(operation.get("id"))
        subscriptions = announcements.named(Kind.SUBSCRIPTION, topic) if found is None else [found]
        for one in subscriptions:
            data = self._payloads.incoming(operation.get("msg"), one.type_name)
            one.end.receive(Sample(data, time.time_ns(), next(self._received)))

    def _receive_request(self, operation: Operation) -> None:
        name = field(operation, "service", str)
        served = self._ready().endpoint(operation.get("served"))
        services = self._ready().named(Kind.SERVICE, name) if served is None else [served]
        self._calls.receive_request(operation, services[0] if services else None)

    def _receive_response(self, operation: Operation) -> None:
        call_id = field(operation, "id", str)
        values = operation.get("values") if operation.get("result") is True else None
        if self._poll is not None and self._poll.receive(call_id, values):
            self._continue_poll(self._poll)
        else:
            self._calls.receive_response(operation)

    def _receive_status(self, operation: Operation) -> None:
        if operation.get("level") in ("error", "warning"):
            endpoint = None if self._announcements is None else self._announcements.endpoint(operation.get("id"))
            where = "" if endpoint is None else f"{endpoint.name}: "
            if self.is_ready or operation.get("id") != _GRAPH:
                self._report_once(f"{where}{operation.get('msg')}")

    def _receive_graph(self, operation: Operation) -> None:
        if self._announcements is None:
            self._begin(is_extended=True)
        self._remote.update(read_graph(operation))

    def _start_poll(self) -> None:
        self._poll = RosapiPoll(self._service_types)
        self._continue_poll(self._poll)

    def _continue_poll(self, poll: RosapiPoll) -> None:
        self._greetings.extend(poll.requests)
        poll.requests.clear()
        if poll.is_done:
            self._poll = None
            if self._announcements is None:
                self._report(FOREIGN)
                self._begin(is_extended=False)
                if not poll.has_answers:
                    self._has_rosapi = False
                    self._report(NO_ROSAPI)
            if self.needs_polls:
                self._remote.update(self._without_own(poll.nodes()))
        self._wake()

    def _begin(self, *, is_extended: bool) -> None:
        self._payloads.is_serialized = is_extended
        self._announcements = Announcements(self._graph, self._remote.is_own, is_extended=is_extended)
        self._wake()

    def _without_own(self, nodes: list[NodeDescription]) -> Iterator[NodeDescription]:
        """The nodes, without what the node of the server has for this program."""
        own = self._ready().names()
        for node in nodes:
            if node.name.startswith("rosbridge"):
                others = tuple(one for one in node.endpoints if (one.kind, one.name) not in own)
                yield NodeDescription(node.name, node.namespace, others)
            else:
                yield node

    def _ready(self) -> Announcements:
        if self._announcements is None:
            raise OperationError("found a message before the first answer")
        return self._announcements

    def _report_limits(self, endpoint: LocalEndpoint) -> None:
        """Say what the server does not carry of an endpoint."""
        if ACTION_PART in endpoint.name and not self._payloads.is_serialized:
            self._report_once(f"{endpoint.name.partition(ACTION_PART)[0]}: the server carries no actions")
        if endpoint.kind is Kind.SERVICE:
            return
        profile = endpoint.end.qos_profile
        if profile.deadline.nanoseconds or profile.liveliness_lease_duration.nanoseconds:
            self._report_once(f"{endpoint.name}: deadline and liveliness are not carried by rosbridge")

    def _report_once(self, text: str) -> None:
        if text not in self._reported and len(self._reported) < _MOST_REPORTS:
            self._reported.add(text)
            self._report(text)


def _ignore(_operation: Operation) -> None:
    """Need nothing: the server confirms."""
