"""What all parts of a node need: names, context, executor, clock and log."""

from __future__ import annotations

import weakref
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Self

from thymio_sim_ros.portable_ros.graph.arguments import Arguments, parse
from thymio_sim_ros.portable_ros.graph.entity import Handle
from thymio_sim_ros.portable_ros.graph.names import expanded, full_topic_problem
from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import RCLError, RCLInvalidROSArgsError
from thymio_sim_ros.portable_ros.rclpy.clock import Clock, ROSClock
from thymio_sim_ros.portable_ros.rclpy.exceptions import NotInitializedException
from thymio_sim_ros.portable_ros.rclpy.impl.rcutils_logger import RcutilsLogger
from thymio_sim_ros.portable_ros.rclpy.logging import get_logger
from thymio_sim_ros.portable_ros.rclpy.utilities import get_default_context
from thymio_sim_ros.portable_ros.rclpy.validate_full_topic_name import validate_full_topic_name
from thymio_sim_ros.portable_ros.rclpy.validate_namespace import validate_namespace
from thymio_sim_ros.portable_ros.rclpy.validate_node_name import validate_node_name
from thymio_sim_ros.portable_ros.rclpy.validate_topic_name import validate_topic_name

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.graph.graph import Graph
    from thymio_sim_ros.portable_ros.rclpy.context import Context
    from thymio_sim_ros.portable_ros.rclpy.executors import Executor

__all__ = ["NodeBase"]


class NodeBase:
    """The part of a node that the other parts build on."""

    def __init__(
        self,
        node_name: str,
        context: Context | None,
        cli_args: Sequence[str] | None,
        namespace: str | None,
        use_global_arguments: bool,
    ) -> None:
        """Raises NotInitializedException, InvalidNodeNameException and InvalidNamespaceException."""
        self._handle = Handle("Node")
        self._context = context or get_default_context()
        if not self._context.ok():
            raise NotInitializedException("cannot create node")
        self._arguments = [
            *([_parsed(cli_args)] if cli_args else []),
            *([self._context.arguments] * use_global_arguments),
        ]
        self._name, self._namespace = self._named(node_name, namespace or "")
        self._executor: Callable[[], Executor | None] = lambda: None
        self._logger = get_logger(self.get_fully_qualified_name().lstrip("/").replace("/", "."))
        self._clock = ROSClock()

    def get_name(self) -> str:
        """The name."""
        with self._handle:
            return self._name

    def get_namespace(self) -> str:
        """The namespace."""
        with self._handle:
            return self._namespace

    def get_fully_qualified_name(self) -> str:
        """Namespace and name."""
        return f"{self._namespace.rstrip('/')}/{self._name}"

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """The full name of a topic, after the rules of the command line unless `only_expand`. Raises RCLError."""
        return self._checked(topic, is_service=False, only_expand=only_expand)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """The full name of a service, after the rules of the command line unless `only_expand`. Raises RCLError."""
        return self._checked(service, is_service=True, only_expand=only_expand)

    @property
    def executor(self) -> Executor | None:
        """The executor that runs the callbacks, None without one."""
        return self._executor()

    @executor.setter
    def executor(self, new_executor: Executor | None) -> None:
        present = self.executor
        if present is new_executor:
            return
        if present is not None:
            present.remove_node(self)
        self._executor = (lambda: None) if new_executor is None else weakref.ref(new_executor)
        if new_executor is not None:
            new_executor.add_node(self)

    @property
    def itself(self) -> Self:
        """The node, also by an object that has its attributes: tools such as ros2cli give these to executors."""
        return self

    @property
    def context(self) -> Context:
        """The context."""
        return self._context

    @property
    def handle(self) -> Handle:
        """The handle."""
        return self._handle

    def get_clock(self) -> Clock:
        """The clock, which has simulated time if `use_sim_time` is true."""
        return self._clock

    def get_logger(self) -> RcutilsLogger:
        """The log."""
        return self._logger

    @property
    def _graph(self) -> Graph:
        return self._context.graph

    def _named(self, name: str, namespace: str) -> tuple[str, str]:
        """Name and namespace after the rules of the command line. Raises for those that are not valid."""
        validate_node_name(name)
        namespace = namespace if namespace.startswith("/") else f"/{namespace}"
        validate_namespace(namespace)
        new_name, new_space = name, namespace
        for arguments in reversed(self._arguments):
            new_name, new_space = arguments.node_name(name), arguments.namespace(name, new_space)
        return new_name, new_space

    def _checked(self, name: str, *, is_service: bool, only_expand: bool) -> str:
        """The full name of a topic or a service. Raises RCLError for one that is not valid."""
        with self._handle:
            try:
                full = self._resolved(name, is_service=is_service, only_expand=only_expand)
            except ValueError as error:
                reason = str(error).rpartition(" is invalid: ")[2]
                raise RCLError(f"failed to resolve name: {reason}") from error
            if problem := full_topic_problem(full):
                raise RCLError(f"failed to resolve name: {problem[0]}")
            return full

    def _resolved(self, name: str, *, is_service: bool, only_expand: bool = False) -> str:
        full = expanded(name, self._name, self._namespace)
        if only_expand:
            return full
        remapped = (one.remapped(full, self._name, self._namespace, is_service=is_service) for one in self._arguments)
        return next((one for one in remapped if one is not None), full)

    def _require_context(self, failure: str) -> None:
        """Raise RCLError after a shutdown of the context; `failure` says what cannot be done."""
        if not self._context.ok():
            raise RCLError(f"{failure}: rcl node's context is invalid")

    def _endpoint_name(self, name: str, *, is_service: bool = False) -> str:
        """The full name of an endpoint. Raises for one that is not valid."""
        with self._handle:
            validate_topic_name(name, is_service=is_service)
            full = self._resolved(name, is_service=is_service)
            validate_full_topic_name(full, is_service=is_service)
            return full


def _parsed(words: Sequence[str]) -> Arguments:
    """The arguments of a node. Raises RCLInvalidROSArgsError and UnknownROSArgsError."""
    try:
        return parse(words)
    except RCLInvalidROSArgsError as error:
        raise RCLInvalidROSArgsError(f"Failed to parse ROS arguments: {error}") from error
