"""The service of a node that describes the types that it uses."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.messages.interface_files import text_of
from thymio_sim_ros.portable_ros.messages.message_class import message_type
from thymio_sim_ros.portable_ros.messages.type_descriptions import HASH_PREFIX, referenced, type_description, type_hash
from thymio_sim_ros.portable_ros.rclpy.logging import get_logger

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy_parts.node_endpoints import NodeEndpoints

__all__ = ["START_TYPE_DESCRIPTION_SERVICE_PARAM", "TypeDescriptionService"]

START_TYPE_DESCRIPTION_SERVICE_PARAM = "start_type_description_service"

_HASH = re.compile(f"{HASH_PREFIX}[0-9a-f]{{64}}")
_FOLDER = "type_description_interfaces/msg"


class TypeDescriptionService:
    """Offers `~/get_type_description`, unless a parameter of the node says no."""

    def __init__(self, node: NodeEndpoints) -> None:
        self._node = node
        if not node.has_parameter(START_TYPE_DESCRIPTION_SERVICE_PARAM):
            descriptor = ros_types.ParameterDescriptor(
                description="If enabled, start the ~/get_type_description service.", read_only=True
            )
            node.declare_parameter(START_TYPE_DESCRIPTION_SERVICE_PARAM, True, descriptor)
        self.service_name = f"{node.get_name()}/get_type_description"
        self.enabled = node.get_parameter(START_TYPE_DESCRIPTION_SERVICE_PARAM).value is True
        if self.enabled:
            node.create_service(ros_types.GetTypeDescription, self.service_name, self._answer)

    def _answer(
        self, request: ros_types.GetTypeDescription.Request, response: ros_types.GetTypeDescription.Response
    ) -> ros_types.GetTypeDescription.Response:
        """Describe a type of an endpoint of the node, or say why not."""
        name = request.type_name
        if not _HASH.fullmatch(request.type_hash):
            response.failure_reason = "Failed to parse type hash"
            get_logger("rcl").error(f"Failed to parse type hash '{request.type_hash}'")
        elif name not in self._used() or type_hash(name) != request.type_hash:
            response.failure_reason = "Type not currently in use by this node"
        else:
            response.successful = True
            response.type_description = _message("TypeDescription", type_description(name))
            if request.include_type_sources:
                response.type_sources = [_source(one) for one in (name, *referenced(name))]
        return response

    def _used(self) -> Iterator[str]:
        node = self._node
        yield from (one.msg_type.TYPE_NAME for one in node.all_publishers)
        yield from (one.msg_type.TYPE_NAME for one in node.all_subscriptions)
        yield from (one.srv_type.TYPE_NAME for one in node.all_services)
        yield from (one.srv_type.TYPE_NAME for one in node.all_clients)
        yield from (one.action_type.TYPE_NAME for one in node._actions)


def _message(short: str, values: dict[str, Any]) -> Any:
    """A message of the values of its fields, which may be messages themselves."""
    kind = message_type(f"{_FOLDER}/{short}")
    inner = {member.field.name: member.field.type.base.rpartition("/")[2] for member in kind.members}

    def made(name: str, value: Any) -> Any:
        if isinstance(value, list):
            return [_message(inner[name], one) for one in value]
        return _message(inner[name], value) if isinstance(value, dict) else value

    return kind(**{name: made(name, value) for name, value in values.items()})


def _source(name: str) -> Any:
    """The text of a file, or that there is none: rosidl has made the type."""
    try:
        text, encoding = text_of(name), name.split("/")[1]
    except KeyError:
        text, encoding = "", "implicit"
    kind = message_type(f"{_FOLDER}/TypeSource")
    return kind(type_name=name, encoding=encoding, raw_file_contents=text)
