"""Descriptions of the nodes of the remote graph."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from thymio_sim_ros.portable_ros.graph.remote_ends import Kind
from thymio_sim_ros.portable_ros.rclpy.qos import QoSProfile
from thymio_sim_ros.portable_ros.rosbridge.operations import Operation, OperationError, field, qos_profile

__all__ = ["NodeDescription", "RemoteEndpoint", "read_graph"]


class RemoteEndpoint(NamedTuple):
    """An endpoint: its kind, full name and type, and, of topics, its policies as far as they are known."""

    kind: Kind
    name: str
    type_name: str
    policies: tuple[tuple[str, Any], ...] = ()

    @property
    def qos_profile(self) -> QoSProfile:
        """The profile. Raises OperationError."""
        return qos_profile(dict(self.policies))


@dataclass(frozen=True, slots=True)
class NodeDescription:
    """A node of the remote graph."""

    name: str
    namespace: str
    endpoints: Sequence[RemoteEndpoint] = ()


def read_graph(operation: Operation) -> list[NodeDescription]:
    """The nodes of an operation `graph`. Raises OperationError."""
    return [_node(one) for one in field(operation, "nodes", list)]


def _node(of: object) -> NodeDescription:
    if not isinstance(of, dict):
        raise OperationError(f"operation 'graph': found node {of!r:.60}, expected an object")
    node = {"op": "graph", **of}
    return NodeDescription(field(node, "name", str), field(node, "namespace", str), tuple(_endpoints(node)))


def _endpoints(node: Operation) -> Iterator[RemoteEndpoint]:
    for kind in Kind:
        ends = f"{kind.value}s"
        for one in field(node, ends, list) if ends in node else ():
            match one:
                case [str(name), str(type_name)]:
                    yield RemoteEndpoint(kind, name, type_name)
                case [str(name), str(type_name), dict(policies)] if _are_plain(policies):
                    found = RemoteEndpoint(kind, name, type_name, tuple(sorted(policies.items())))
                    assert found.qos_profile is not None  # raises OperationError for wrong policies
                    yield found
                case _:
                    raise OperationError(
                        f"operation 'graph': found {ends} with {one!r:.60}, expected [name, type] or [name, type, qos]"
                    )


def _are_plain(policies: dict[object, object]) -> bool:
    """Whether these are names with texts and numbers; CBOR has other keys, too."""
    return all(isinstance(key, str) and isinstance(value, str | int) for key, value in policies.items())
