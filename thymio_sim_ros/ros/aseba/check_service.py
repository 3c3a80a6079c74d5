"""The service `~/check`: compile a text without loading it (docs/aseba_ros.md names the fields).

The request has the text and its options as parameters, and the answer is JSON in the reason of the result, so that the
service has a standard type and works in every tool and through every bridge.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import lru_cache
from typing import Any

from rcl_interfaces.msg import Parameter as ParameterMsg
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.node import Node
from rclpy.parameter import Parameter

from thymio_sim_ros.device.editor.language_service import Question, check, describe_target, refusal
from thymio_sim_ros.errors import ThymioSimError

__all__ = ["CheckService", "RequestError", "refused", "values_of"]

_TYPES = {
    "source": (Parameter.Type.STRING,),
    "name": (Parameter.Type.STRING,),
    "language": (Parameter.Type.STRING,),
    "events": (Parameter.Type.STRING_ARRAY,),
    "constants": (Parameter.Type.STRING_ARRAY,),
    "target": (Parameter.Type.BOOL,),
}


class RequestError(ThymioSimError, ValueError):
    """An invalid request; the message says why."""


class CheckService:
    """The service `~/check`; `layout` returns the layout of the robots.

    `robots` returns the names of robots that a node of a file can belong to.
    """

    def __init__(self, node: Node, *, layout: Callable[[], str], robots: Callable[[], Iterable[str]]) -> None:
        self._layout = layout
        self._robots = robots
        node.create_service(SetParametersAtomically, "~/check", self._on_check)

    def _on_check(
        self, request: SetParametersAtomically.Request, response: SetParametersAtomically.Response
    ) -> SetParametersAtomically.Response:
        try:
            given = values_of(request.parameters, _TYPES)
            if "source" not in given:
                raise RequestError("found no parameter 'source', expected the text of a program")
            response.result = self.check(given)
        except RequestError as error:
            response.result = refused(str(error))
        return response

    def check(self, given: Mapping[str, Any]) -> SetParametersResult:
        """Return whether a text compiles, with the answer in JSON. Raises RequestError for wrong values."""
        question = Question(
            source=given["source"],
            layout=self._layout(),
            language=given.get("language", "en"),
            events=_pairs("events", given.get("events", ())),
            constants=_pairs("constants", given.get("constants", ())),
            robots=tuple(name for name in self._robots() if name),
        )
        successful, answer = _answer(question)
        if given.get("target"):
            answer = json.dumps(json.loads(answer) | {"target": describe_target(self._layout(), question.language)})
        return SetParametersResult(successful=successful, reason=answer)


def refused(reason: str) -> SetParametersResult:
    """The answer to a request that cannot be executed."""
    return SetParametersResult(successful=False, reason=json.dumps(refusal(reason)))


@lru_cache(maxsize=16)
def _answer(question: Question) -> tuple[bool, str]:
    """Return whether a text compiles, and the JSON. Cached, since editors check the same text repeatedly."""
    answer = check(question)
    return not answer["errors"], json.dumps(answer)


def values_of(parameters: Sequence[ParameterMsg], types: Mapping[str, tuple[Parameter.Type, ...]]) -> dict[str, Any]:
    """Return the values of a request by name. Raises RequestError for names or types that are not in `types`."""
    values: dict[str, Any] = {}
    for message in parameters:
        try:
            parameter = Parameter.from_parameter_msg(message)
        except ValueError as error:
            kind = message.value.type
            raise RequestError(f"{message.name}: found a value of unknown type {kind}") from error
        if parameter.name not in types:
            raise RequestError(f"found parameter '{parameter.name}', expected one of {', '.join(types)}")
        is_empty_list = parameter.value is not None and parameter.type_.name.endswith("ARRAY") and not parameter.value
        expected = types[parameter.name]
        if parameter.type_ not in expected and not (is_empty_list and Parameter.Type.STRING_ARRAY in expected):
            raise RequestError(f"{parameter.name}: found {parameter.type_.name}, expected {expected[0].name}")
        values[parameter.name] = parameter.value
    return values


def _pairs(name: str, items: Iterable[str]) -> tuple[tuple[str, int], ...]:
    """Parse items such as `ping 1` into pairs of name and number."""
    pairs = []
    for item in items:
        word, _, number = item.rpartition(" ")
        try:
            pairs.append((word.strip(), int(number)))
        except ValueError as error:
            raise RequestError(f"{name}: found '{item}', expected a name and a number, as 'ping 1'") from error
    return tuple(pairs)
