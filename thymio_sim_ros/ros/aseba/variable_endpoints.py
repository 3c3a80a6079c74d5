"""Services and topics for the variables of one robot's program.

Source: docs/spec/ros-interface.md section 6.2.
"""

from __future__ import annotations

import re
import time
from collections.abc import Sequence

from rcl_interfaces.msg import (
    IntegerRange,
    ListParametersResult,
    ParameterDescriptor,
    ParameterType,
    ParameterValue,
    SetParametersResult,
)
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters
from rclpy.node import Node
from rclpy.publisher import Publisher
from std_msgs.msg import Int16MultiArray

from thymio_sim_ros.device.editor.help import help_of
from thymio_sim_ros.device.robot_device import RobotDevice
from thymio_sim_ros.engine.inputs import VariableSet
from thymio_sim_ros.ros.aseba.event_endpoints import unique_topic_words
from thymio_sim_ros.ros.aseba.program_owner import ProgramOwner
from thymio_sim_ros.ros.interface import convert_readings, qos
from thymio_sim_ros.ros.interface.names import RobotNames, full_name

__all__ = ["VariableEndpoints"]

AT_LEAST_EVERY_S = 1.0
"""Period after which an unchanged table of variables is published again for new subscribers."""

_ELEMENT = re.compile(r"(?P<name>.+)\[(?P<index>\d{1,5})\]")


class VariableEndpoints:
    """Reads and writes the variables of a robot's device."""

    def __init__(self, node: Node, names: RobotNames, owner: ProgramOwner, robot: str, *, language: str) -> None:
        """`owner` has the device of the robot, `robot` is its name there; `language` is that of help texts."""
        self.language = language
        self._node = node
        self._names = names
        self._owner, self._robot = owner, robot
        self._watched: dict[str, Publisher[Int16MultiArray]] = {}
        self._published: dict[str, tuple[int, ...]] = {}
        self._places: list[tuple[str, int, int]] = []
        self._last_table: list[int] = []
        self._last_table_s = 0.0
        topic = names.topic
        self._table = node.create_publisher(Int16MultiArray, topic("_aseba/variables"), qos.SENSOR)
        self._services = [
            node.create_service(GetParameters, topic("aseba/get_variables"), self._on_get),
            node.create_service(SetParameters, topic("aseba/set_variables"), self._on_set),
            node.create_service(ListParameters, topic("aseba/list_variables"), self._on_list),
            node.create_service(DescribeParameters, topic("aseba/describe_variables"), self._on_describe),
        ]

    def set_program(self, watch: Sequence[str]) -> None:
        """Set up the variables of a new program, and topics for the watched ones that exist."""
        places = self._device.variables.addresses()
        self._places = sorted(((name, *place) for name, place in places.items()), key=lambda item: item[1])
        self._layout = convert_readings.layout([(name, size) for name, _, size in self._places])
        self._last_table = []
        words, _ = unique_topic_words([name for name in dict.fromkeys(watch) if name in places], self._topic)
        for name in [name for name in self._watched if name not in words]:
            self._node.destroy_publisher(self._watched.pop(name))
        for name, word in words.items():
            if name not in self._watched:
                self._watched[name] = self._node.create_publisher(
                    Int16MultiArray, self._topic(word), qos.TRANSIENT_LOCAL
                )
        self._published.clear()

    def publish_changes(self) -> None:
        """Publish variables that changed since the last call."""
        for name, publisher in self._watched.items():
            words = self._device.variables.get(name)
            if self._published.get(name) != words:
                self._published[name] = words
                publisher.publish(Int16MultiArray(data=list(words)))
        if self._table.get_subscription_count():
            self._publish_table()

    def close(self) -> None:
        """Destroy topics and services."""
        for publisher in (*self._watched.values(), self._table):
            self._node.destroy_publisher(publisher)
        for service in self._services:
            self._node.destroy_service(service)

    @property
    def _device(self) -> RobotDevice:
        return self._owner.hosts[self._robot].device

    def _topic(self, word: str) -> str:
        return full_name(self._node, self._names.topic(f"aseba/variables/{word}"))

    def _publish_table(self) -> None:
        words = self._device.variables.words()
        now_s = time.monotonic()
        if words != self._last_table or now_s - self._last_table_s >= AT_LEAST_EVERY_S:
            self._last_table, self._last_table_s = words, now_s
            self._table.publish(Int16MultiArray(layout=self._layout, data=words))

    def _on_get(self, request: GetParameters.Request, response: GetParameters.Response) -> GetParameters.Response:
        response.values = [self._value(name) for name in request.names]
        return response

    def _value(self, name: str) -> ParameterValue:
        whole, index = _element(name)
        try:
            words = self._device.variables.get(whole)
            found = words if index is None else (words[index],)
        except (KeyError, IndexError):
            return ParameterValue()
        return ParameterValue(type=ParameterType.PARAMETER_INTEGER_ARRAY, integer_array_value=list(found))

    def _on_set(self, request: SetParameters.Request, response: SetParameters.Response) -> SetParameters.Response:
        response.results = [self._set(item.name, item.value) for item in request.parameters]
        return response

    def _set(self, name: str, value: ParameterValue) -> SetParametersResult:
        try:
            self._write(name, _words(name, value))
        except KeyError:
            return SetParametersResult(successful=False, reason=f"no variable is called '{name}'")
        except (IndexError, ValueError) as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _write(self, name: str, words: list[int]) -> None:
        whole, index = _element(name)
        if index is None:
            self._write_variable(whole, words)
            return
        all_words = list(self._device.variables.get(whole))
        if index >= len(all_words):
            raise IndexError(f"{whole}: found element {index}, expected 0 to {len(all_words) - 1}")
        if len(words) != 1:
            raise ValueError(f"{name}: found {len(words)} integers, expected 1")
        all_words[index] = words[0]
        self._write_variable(whole, all_words)

    def _write_variable(self, name: str, words: Sequence[int]) -> None:
        self._owner.apply(VariableSet(self._robot, name, tuple(words)))

    def _on_list(self, request: ListParameters.Request, response: ListParameters.Response) -> ListParameters.Response:
        names = [name for name, _, _ in self._places if _is_wanted(name, list(request.prefixes), request.depth)]
        prefixes = dict.fromkeys(name.rpartition(".")[0] for name in names if "." in name)
        response.result = ListParametersResult(names=names, prefixes=list(prefixes))
        return response

    def _on_describe(
        self, request: DescribeParameters.Request, response: DescribeParameters.Response
    ) -> DescribeParameters.Response:
        response.descriptors = [self._descriptor(name) for name in request.names]
        return response

    def _descriptor(self, name: str) -> ParameterDescriptor:
        place = self._device.variables.addresses().get(name)
        if place is None:
            return ParameterDescriptor(name=name)
        return ParameterDescriptor(
            name=name,
            type=ParameterType.PARAMETER_INTEGER_ARRAY,
            description=help_of("variables", name, self.language, other="a variable of the program"),
            additional_constraints=f"{place[1]} value{'s' if place[1] > 1 else ''}",
            integer_range=[IntegerRange(from_value=-0x8000, to_value=0x7FFF, step=1)],
        )


def _element(name: str) -> tuple[str, int | None]:
    found = _ELEMENT.fullmatch(name)
    return (name, None) if found is None else (found["name"], int(found["index"]))


def _words(name: str, value: ParameterValue) -> list[int]:
    if value.type == ParameterType.PARAMETER_INTEGER:
        return [value.integer_value]
    if value.type == ParameterType.PARAMETER_INTEGER_ARRAY:
        return list(value.integer_array_value)
    raise ValueError(f"{name}: found a value of type {value.type}, expected an integer (2) or an integer array (7)")


def _is_wanted(name: str, prefixes: Sequence[str], depth: int) -> bool:
    """Whether a name matches prefixes and depth as in ListParameters of nodes; depth 0 means any."""

    def is_shallow(rest: str) -> bool:
        return depth == ListParameters.Request.DEPTH_RECURSIVE or rest.count(".") < depth

    if not prefixes:
        return is_shallow(name)
    return any(
        name == prefix or (name.startswith(f"{prefix}.") and is_shallow(name[len(prefix) + 1 :])) for prefix in prefixes
    )
