"""What tests of the Aseba runtime share: parameters, variables, status, all by topics and services."""

from __future__ import annotations

import json

from diagnostic_msgs.msg import DiagnosticStatus
from rcl_interfaces.msg import Parameter as ParameterMsg
from rcl_interfaces.msg import ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters, SetParameters, SetParametersAtomically
from rclpy.parameter import Parameter
from sensor_msgs.msg import Range
from std_msgs.msg import Bool, Int16MultiArray, MultiArrayDimension, MultiArrayLayout

from thymio_sim_ros.ros.interface.names import PROXIMITY


def set_parameters(ros, wanted, node="/aseba_runtime"):
    parameters = [Parameter(name, value=value).to_parameter_msg() for name, value in wanted.items()]
    request = SetParametersAtomically.Request(parameters=parameters)
    return ros.call(SetParametersAtomically, f"{node}/set_parameters_atomically", request).result


def get_parameter(ros, name):
    answer = ros.call(GetParameters, "/aseba_runtime/get_parameters", GetParameters.Request(names=[name]))
    return Parameter.from_parameter_msg(ParameterMsg(name=name, value=answer.values[0])).value


def get_variables(ros, *names, robot=""):
    answer = ros.call(GetParameters, f"{robot}/aseba/get_variables", GetParameters.Request(names=names))
    return [
        list(value.integer_array_value) if value.type == ParameterType.PARAMETER_INTEGER_ARRAY else None
        for value in answer.values
    ]


def set_variables(ros, wanted, robot=""):
    parameters = [ParameterMsg(name=name, value=value) for name, value in wanted.items()]
    request = SetParameters.Request(parameters=parameters)
    return ros.call(SetParameters, f"{robot}/aseba/set_variables", request).results


def words(*values):
    return ParameterValue(type=ParameterType.PARAMETER_INTEGER_ARRAY, integer_array_value=values)


def event(name, *values):
    dimension = MultiArrayDimension(label=name, size=len(values), stride=len(values))
    return Int16MultiArray(layout=MultiArrayLayout(dim=[dimension]), data=values)


class Proximity:
    """The proximity sensors of a robot, as its driver publishes them."""

    def __init__(self, ros, robot=""):
        self._publishers = [ros.publisher(Range, f"{robot}/proximity/{name}", depth=1) for name in PROXIMITY]

    def send(self, *ranges):
        """Publish seven ranges in m; the driver has -1.0 for no obstacle."""
        for publisher, value in zip(self._publishers, ranges, strict=True):
            publisher.publish(seen(value))


def seen(range_m):
    """The message of a proximity sensor."""
    return Range(min_range=0.0215, max_range=0.14, range=range_m)


def press(ros, button, robot=""):
    """Publish that a button is pressed, as the driver does."""
    ros.publisher(Bool, f"{robot}/buttons/{button}").publish(Bool(data=True))


class Status:
    """The last status of a robot's machine."""

    def __init__(self, ros, robot=""):
        self.messages = ros.collect(DiagnosticStatus, f"{robot}/_aseba/status", transient_local=True)

    def __getitem__(self, key):
        if not self.messages:
            return None
        return {item.key: item.value for item in self.messages[-1].values}[key]

    def data(self, key):
        return json.loads(self[key]) if self.messages else None

    @property
    def place(self):
        return (self["state"], self["event"], self["line"])
