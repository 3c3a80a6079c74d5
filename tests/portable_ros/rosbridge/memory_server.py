"""A rosbridge server in memory: connects the graphs of several sessions, as a suite or as rosbridge_suite does."""

from __future__ import annotations

import itertools
from typing import Any

from thymio_sim_ros.portable_ros.graph.graph import Graph
from thymio_sim_ros.portable_ros.graph.protocols import PublisherEnd, Sample
from thymio_sim_ros.portable_ros.rclpy.context import Context
from thymio_sim_ros.portable_ros.rclpy.executors import SingleThreadedExecutor, TimeoutException
from thymio_sim_ros.portable_ros.rclpy.node import Node
from thymio_sim_ros.portable_ros.rosbridge.operations import Operation, decode, encode
from thymio_sim_ros.portable_ros.rosbridge.session import Session
from thymio_sim_ros.ros.foxglove import json_messages

__all__ = ["MemoryServer", "Program"]

_domains = itertools.count(10_000)


class Program:
    """The graph of a process of its own, with a transport to a server in memory."""

    def __init__(self) -> None:
        self.reports: list[str] = []
        self.session: Session | None = None
        self.context = Context()
        self.context.init([], domain_id=next(_domains))
        self.executor = SingleThreadedExecutor(context=self.context)
        self.graph: Graph = self.context.graph
        self.graph.attach(self)

    @property
    def is_connected(self) -> bool:
        """Whether there is a session that carries messages."""
        return self.session is not None and self.session.is_ready

    def graph_changed(self) -> None:
        """Pass it on."""
        if self.session is not None:
            self.session.graph_changed()

    def publish(self, publisher: PublisherEnd, sample: Sample) -> bool:
        """Pass it on."""
        return self.session is not None and self.session.publish(publisher, sample)

    def node(self, name: str, **options: Any) -> Node:
        """A node that the executor spins."""
        made = Node(name, context=self.context, **options)
        self.executor.add_node(made)
        return made


class MemoryServer:
    """Passes on what sessions send. `sent` has all their operations; a foreign server knows no nodes and no CDR."""

    def __init__(self, *, is_foreign: bool = False, has_rosapi: bool = True) -> None:
        self.is_foreign, self.has_rosapi = is_foreign, has_rosapi
        self.programs: list[Program] = []
        self.sent: list[Operation] = []
        self._ends: list[tuple[Program, Operation]] = []
        self._nodes: list[tuple[Program, Operation]] = []
        self._graph_readers: list[Program] = []
        self._callers: dict[str, tuple[Program, Operation]] = {}
        self._numbers = itertools.count(1)

    def connect(self, program: Program) -> None:
        """Connect a program."""
        program.session = Session(program.graph, json_messages, lambda: None, program.reports.append)
        self.programs.append(program)
        self.run()

    def disconnect(self, program: Program) -> None:
        """End the connection of a program."""
        session, program.session = program.session, None
        assert session is not None
        session.end()
        self.programs.remove(program)
        self._graph_readers = [one for one in self._graph_readers if one is not program]
        self._ends = [one for one in self._ends if one[0] is not program]
        self._nodes = [one for one in self._nodes if one[0] is not program]
        self.run()

    def run(self) -> None:
        """Pass operations on and execute callbacks until there is nothing left to do."""
        while any([self._pass_on(program) for program in list(self.programs)] + [_spin(one) for one in self.programs]):
            pass

    def said(self, op: str) -> list[Operation]:
        """The operations of a kind that programs have sent."""
        return [one for one in self.sent if one["op"] == op]

    def tell(self, program: Program, operation: Operation) -> None:
        """Send an operation to a program."""
        assert program.session is not None
        program.session.receive(encode(operation, is_binary=not self.is_foreign))

    def _pass_on(self, program: Program) -> bool:
        assert program.session is not None
        frames = list(program.session.frames())
        for frame in frames:
            assert isinstance(frame, str) or not self.is_foreign
            operation = decode(frame)
            self.sent.append(operation)
            if self.is_foreign and operation["op"] in ("graph", "node", "remove_node"):
                continue
            getattr(self, f"_{operation['op']}")(program, operation)
        return bool(frames)

    def _graph(self, program: Program, _operation: Operation) -> None:
        self._graph_readers.append(program)
        self._send_graphs()

    def _node(self, program: Program, operation: Operation) -> None:
        self._nodes.append((program, operation))
        self.tell(program, operation)
        self._send_graphs()

    def _remove_node(self, program: Program, operation: Operation) -> None:
        self._nodes = [(one, node) for one, node in self._nodes if (one, node["id"]) != (program, operation["id"])]
        self._send_graphs()

    def _advertise(self, program: Program, operation: Operation) -> None:
        self._ends.append((program, operation))
        self._send_graphs()

    _subscribe = _advertise_service = _advertise

    def _unadvertise(self, program: Program, operation: Operation) -> None:
        self._check_known(program, operation)
        self._ends = [(one, end) for one, end in self._ends if (one, end["id"]) != (program, operation["id"])]
        self._send_graphs()

    _unsubscribe = _unadvertise_service = _unadvertise

    def _publish(self, program: Program, operation: Operation) -> None:
        self._check_known(program, operation)
        reached = set()
        for one, end in self._ends:
            if end["op"] == "subscribe" and end["topic"] == operation["topic"] and (self._id(end), one) not in reached:
                reached.add((self._id(end), one))
                self.tell(one, {"op": "publish", "topic": end["topic"], **self._id_field(end), "msg": operation["msg"]})

    def _check_known(self, program: Program, operation: Operation) -> None:
        """Check that an operation is about an endpoint: for a suite, the one of its node with its id."""
        ends = [end for one, end in self._ends if one is program and end["id"] == operation["id"]]
        assert [end.get("node") for end in ends] == [operation.get("node")], operation

    def _call_service(self, program: Program, operation: Operation) -> None:
        name = operation["service"]
        if self.is_foreign and self.has_rosapi and name.startswith("/rosapi/"):
            values = getattr(self, f"_rosapi_{name.rpartition('/')[2]}")(**operation["args"])
            answer = {"op": "service_response", "id": operation["id"], "service": name}
            self.tell(program, {**answer, "values": values, "result": True})
            return
        for one, end in self._ends:
            if end["op"] == "advertise_service" and end["service"] == name:
                call_id = f"request{next(self._numbers)}"
                self._callers[call_id] = (program, operation)
                self.tell(one, {"op": "call_service", "id": call_id, "service": name, "args": operation["args"]})
                return
        answer = {"op": "service_response", "id": operation["id"], "service": name}
        self.tell(program, {**answer, "values": f"Service {name} does not exist", "result": False})

    def _service_response(self, program: Program, operation: Operation) -> None:
        caller, call = self._callers.pop(operation["id"])
        self.tell(caller, {**operation, "id": call["id"]})

    def _id(self, end: Operation) -> str:
        """Of several subscriptions of a client, a foreign server sends one message."""
        return "" if self.is_foreign else end["id"]

    def _id_field(self, end: Operation) -> Operation:
        return {} if self.is_foreign else {"id": end["id"]}

    def _send_graphs(self) -> None:
        for program in self._graph_readers:
            nodes = [self._described(one, node) for one, node in self._nodes if one is not program]
            self.tell(program, {"op": "graph", "id": "graph", "nodes": nodes})

    def _described(self, program: Program, node: Operation) -> Operation:
        found: Operation = {"name": node["name"], "namespace": node["namespace"]}
        ends = [end for one, end in self._ends if one is program and end["node"] == node["id"]]
        for op, key in (("advertise", "publishers"), ("subscribe", "subscriptions")):
            found[key] = [[one["topic"], one["type"], one["qos"]] for one in ends if one["op"] == op]
        found["services"] = [[one["service"], one["type"]] for one in ends if one["op"] == "advertise_service"]
        return found

    def _rosapi_nodes(self) -> Operation:
        return {"nodes": ["/rosbridge_websocket"]}

    def _rosapi_topics(self) -> Operation:
        topics = {one["topic"]: one["type"] for _, one in self._ends if "topic" in one}
        return {"topics": list(topics), "types": list(topics.values())}

    def _rosapi_services(self) -> Operation:
        return {"services": [one["service"] for _, one in self._ends if "service" in one]}

    def _rosapi_service_type(self, service: str) -> Operation:
        return {"type": next(one["type"] for _, one in self._ends if one.get("service") == service)}

    def _rosapi_node_details(self, node: str) -> Operation:
        ends = [one for _, one in self._ends]
        return {
            "publishing": [one["topic"] for one in ends if one["op"] == "advertise"],
            "subscribing": [one["topic"] for one in ends if one["op"] == "subscribe"],
            "services": [one["service"] for one in ends if one["op"] == "advertise_service"],
        }


def _spin(program: Program) -> bool:
    """Execute what is ready now; return whether there was something."""
    has_run = False
    while True:
        try:
            task, _, _ = program.executor.wait_for_ready_callbacks(timeout_sec=0)
        except TimeoutException:
            return has_run
        has_run = True
        task()
        if task.done() and (error := task.exception()) is not None:
            raise error
