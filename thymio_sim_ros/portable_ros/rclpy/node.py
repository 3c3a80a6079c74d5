"""Nodes."""

from __future__ import annotations

import weakref
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.graph.arguments import Arguments, parse
from thymio_sim_ros.portable_ros.graph.endpoint_events import EndpointEvents
from thymio_sim_ros.portable_ros.graph.entity import Entity, Handle
from thymio_sim_ros.portable_ros.graph.names import expanded
from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import NodeNameNonExistentError as NodeNameNonExistentError
from thymio_sim_ros.portable_ros.rclpy.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup
from thymio_sim_ros.portable_ros.rclpy.client import Client
from thymio_sim_ros.portable_ros.rclpy.clock import Clock, ROSClock
from thymio_sim_ros.portable_ros.rclpy.constants import S_TO_NS
from thymio_sim_ros.portable_ros.rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from thymio_sim_ros.portable_ros.rclpy.exceptions import NotInitializedException
from thymio_sim_ros.portable_ros.rclpy.guard_condition import GuardCondition
from thymio_sim_ros.portable_ros.rclpy.impl.rcutils_logger import RcutilsLogger
from thymio_sim_ros.portable_ros.rclpy.logging import get_logger
from thymio_sim_ros.portable_ros.rclpy.node_graph import NodeGraph
from thymio_sim_ros.portable_ros.rclpy.node_parameters import NodeParameters
from thymio_sim_ros.portable_ros.rclpy.node_rosout import Rosout
from thymio_sim_ros.portable_ros.rclpy.parameter import Parameter
from thymio_sim_ros.portable_ros.rclpy.parameter_service import ParameterService
from thymio_sim_ros.portable_ros.rclpy.publisher import Publisher
from thymio_sim_ros.portable_ros.rclpy.qos import (
    QoSProfile,
    qos_profile_parameter_events,
    qos_profile_services_default,
)
from thymio_sim_ros.portable_ros.rclpy.qos_overriding_options import QoSOverridingOptions, override
from thymio_sim_ros.portable_ros.rclpy.service import Service
from thymio_sim_ros.portable_ros.rclpy.subscription import Subscription
from thymio_sim_ros.portable_ros.rclpy.time_source import TimeSource
from thymio_sim_ros.portable_ros.rclpy.timer import Rate, Timer
from thymio_sim_ros.portable_ros.rclpy.type_support import check_is_valid_msg_type, check_is_valid_srv_type
from thymio_sim_ros.portable_ros.rclpy.utilities import get_default_context
from thymio_sim_ros.portable_ros.rclpy.validate_full_topic_name import validate_full_topic_name
from thymio_sim_ros.portable_ros.rclpy.validate_namespace import validate_namespace
from thymio_sim_ros.portable_ros.rclpy.validate_node_name import validate_node_name
from thymio_sim_ros.portable_ros.rclpy.validate_topic_name import validate_topic_name

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy.context import Context
    from thymio_sim_ros.portable_ros.rclpy.executors import Executor

__all__ = ["Node", "NodeNameNonExistentError"]

HIDDEN_NODE_PREFIX = "_"
_TYPE_DESCRIPTION = "start_type_description_service"

E = TypeVar("E", bound=Entity)


class Node(NodeParameters, NodeGraph):
    """A node of the graph. Its callbacks run in the executor that it is added to."""

    PARAM_REL_TOL = 1e-6

    def __init__(
        self,
        node_name: str,
        *,
        context: Context | None = None,
        cli_args: Sequence[str] | None = None,
        namespace: str | None = None,
        use_global_arguments: bool = True,
        enable_rosout: bool = True,
        start_parameter_services: bool = True,
        parameter_overrides: Sequence[Parameter] | None = None,
        allow_undeclared_parameters: bool = False,
        automatically_declare_parameters_from_overrides: bool = False,
        enable_logger_service: bool = False,
    ) -> None:
        """Raises NotInitializedException, InvalidNodeNameException and InvalidNamespaceException."""
        self._handle = Handle("Node")
        self._context = context or get_default_context()
        if not self._context.ok():
            raise NotInitializedException("cannot create node")
        self._arguments = [
            *([parse(cli_args)] if cli_args else []),
            *([self._context.arguments] * use_global_arguments),
        ]
        self._name, self._namespace = self._named(node_name, namespace or "")
        self._executor: Callable[[], Executor | None] = lambda: None
        self._endpoints: dict[type, list[Any]] = {
            kind: [] for kind in (Publisher, Subscription, Client, Service, Timer, GuardCondition, EndpointEvents)
        }
        self._default_callback_group: CallbackGroup = MutuallyExclusiveCallbackGroup()
        self._logger = get_logger(self.get_fully_qualified_name().lstrip("/").replace("/", "."))
        self._graph.add_node(self)
        self._rosout = Rosout(self) if enable_rosout and self._context.arguments.has_rosout else None
        self._clock = ROSClock()
        self._prepare_parameters(
            self._overrides(parameter_overrides or ()), is_undeclared_allowed=allow_undeclared_parameters
        )
        self._parameter_event_publisher = self.create_publisher(
            ros_types.ParameterEvent, "/parameter_events", qos_profile_parameter_events
        )
        if automatically_declare_parameters_from_overrides:
            items = [
                (name, one.value, ros_types.ParameterDescriptor()) for name, one in self._parameter_overrides.items()
            ]
            self.declare_parameters("", items, ignore_override=True)
        self._time_source = TimeSource(node=self)
        self._time_source.attach_clock(self._clock)
        if start_parameter_services:
            self._parameter_service = ParameterService(self)
        if not self.has_parameter(_TYPE_DESCRIPTION):
            descriptor = ros_types.ParameterDescriptor(
                description="If enabled, start the ~/get_type_description service.", read_only=True
            )
            self.declare_parameter(_TYPE_DESCRIPTION, True, descriptor)

    # --- names ---

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
        """The full name of a topic, after the rules of the command line unless `only_expand`."""
        with self._handle:
            return self._resolved(topic, only_expand=only_expand)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """The full name of a service, after the rules of the command line unless `only_expand`."""
        with self._handle:
            return self._resolved(service, only_expand=only_expand)

    # --- what the node has ---

    @property
    def publishers(self) -> Iterator[Publisher]:
        """The publishers."""
        yield from list(self._endpoints[Publisher])

    @property
    def subscriptions(self) -> Iterator[Subscription]:
        """The subscriptions."""
        yield from list(self._endpoints[Subscription])

    @property
    def clients(self) -> Iterator[Client]:
        """The clients."""
        yield from list(self._endpoints[Client])

    @property
    def services(self) -> Iterator[Service]:
        """The services."""
        yield from list(self._endpoints[Service])

    @property
    def timers(self) -> Iterator[Timer]:
        """The timers."""
        yield from list(self._endpoints[Timer])

    @property
    def guards(self) -> Iterator[GuardCondition]:
        """The guard conditions."""
        yield from list(self._endpoints[GuardCondition])

    def entities(self) -> list[Entity]:
        """All that an executor executes."""
        kinds = (kind for kind in self._endpoints if kind is not Publisher)
        return [entity for kind in kinds for entity in self._endpoints[kind]]

    @property
    def executor(self) -> Executor | None:
        """The executor that runs the callbacks."""
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
    def context(self) -> Context:
        """The context."""
        return self._context

    @property
    def default_callback_group(self) -> CallbackGroup:
        """The group of all callbacks for which no other is given."""
        return self._default_callback_group

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

    # --- endpoints ---

    def create_publisher(
        self,
        msg_type: Any,
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: PublisherEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
    ) -> Publisher:
        """Publish a topic. Raises InvalidTopicNameException and errors about type and profile."""
        check_is_valid_msg_type(msg_type)
        full, profile = self._endpoint_name(topic), _profile(qos_profile)
        if qos_overriding_options is not None:
            override("publisher", self, full, profile, qos_overriding_options)
        callbacks = event_callbacks or PublisherEventCallbacks()
        incompatible = callbacks.incompatible_callback(full, self._logger.warning)
        events = self._owned(
            EndpointEvents(callback_group or self._default_callback_group, callbacks.matched, incompatible)
        )
        made = Publisher(self._context, msg_type, full, profile, events, self._logger.name)
        self._endpoints[Publisher].append(made)
        self._graph.add_publisher(made)
        return made

    def create_subscription(
        self,
        msg_type: Any,
        topic: str,
        callback: Callable[..., Any],
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool = False,
    ) -> Subscription:
        """Subscribe to a topic; `raw`: the callback gets bytes. Raises as `create_publisher`."""
        check_is_valid_msg_type(msg_type)
        full, profile = self._endpoint_name(topic), _profile(qos_profile)
        if qos_overriding_options is not None:
            override("subscription", self, full, profile, qos_overriding_options)
        group = callback_group or self._default_callback_group
        callbacks = event_callbacks or SubscriptionEventCallbacks()
        incompatible = callbacks.incompatible_callback(full, self._logger.warning)
        events = self._owned(EndpointEvents(group, callbacks.matched, incompatible))
        made = Subscription(msg_type, full, callback, group, profile, raw, events, self._logger.name)
        self._owned(made)
        self._graph.add_subscription(made)
        return made

    def create_client(
        self,
        srv_type: Any,
        srv_name: str,
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Client:
        """Call a service. Raises InvalidServiceNameException and errors about the type."""
        check_is_valid_srv_type(srv_type)
        full = self._endpoint_name(srv_name, is_service=True)
        group = callback_group or self._default_callback_group
        made = self._owned(Client(self._context, srv_type, full, qos_profile, group, self._logger.name))
        self._graph.add_client(made)
        return made

    def create_service(
        self,
        srv_type: Any,
        srv_name: str,
        callback: Callable[..., Any],
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Service:
        """Offer a service. Raises InvalidServiceNameException and errors about the type."""
        check_is_valid_srv_type(srv_type)
        full = self._endpoint_name(srv_name, is_service=True)
        group = callback_group or self._default_callback_group
        made = self._owned(Service(srv_type, full, callback, group, qos_profile, self._logger.name))
        self._graph.add_service(made)
        return made

    def create_timer(
        self,
        timer_period_sec: float,
        callback: Callable[..., Any] | None,
        callback_group: CallbackGroup | None = None,
        clock: Clock | None = None,
        autostart: bool = True,
    ) -> Timer:
        """Call back periodically, by the clock of the node unless another one is given."""
        period_ns = int(float(timer_period_sec) * S_TO_NS)
        group = callback_group or self._default_callback_group
        made = self._owned(
            Timer(callback, group, period_ns, clock or self._clock, context=self._context, autostart=autostart)
        )
        if self.executor is not None:
            self.executor.wake()
        return made

    def create_guard_condition(
        self, callback: Callable[..., Any], callback_group: CallbackGroup | None = None
    ) -> GuardCondition:
        """Call back when it is triggered."""
        return self._owned(GuardCondition(callback, callback_group or self._default_callback_group, self._context))

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """Sleep so many times per second. Raises ValueError for a frequency that is not positive."""
        if frequency <= 0:
            raise ValueError("frequency must be > 0")
        return Rate(self.create_timer(1.0 / frequency, None, clock=clock), context=self._context)

    def destroy_publisher(self, publisher: Publisher) -> bool:
        """Remove a publisher; return whether it was one of this node."""
        if not self._remove(publisher):
            return False
        self._graph.remove_publisher(publisher)
        self._remove(publisher.events)
        return True

    def destroy_subscription(self, subscription: Subscription) -> bool:
        """Remove a subscription; return whether it was one of this node."""
        if not self._remove(subscription):
            return False
        self._graph.remove_subscription(subscription)
        self._remove(subscription.events)
        return True

    def destroy_client(self, client: Client) -> bool:
        """Remove a client; return whether it was one of this node."""
        is_own = self._remove(client)
        self._graph.remove_client(client)
        return is_own

    def destroy_service(self, service: Service) -> bool:
        """Remove a service; return whether it was one of this node."""
        is_own = self._remove(service)
        self._graph.remove_service(service)
        return is_own

    def destroy_timer(self, timer: Timer) -> bool:
        """Remove a timer; return whether it was one of this node."""
        return self._remove(timer)

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        """Remove a guard condition; return whether it was one of this node."""
        return self._remove(guard)

    def destroy_rate(self, rate: Rate) -> bool:
        """Remove a rate and its timer."""
        rate.destroy()
        return self._remove(rate.timer)

    def destroy_node(self) -> None:
        """Remove the node with all that it has."""
        if not self._handle.is_valid:
            return
        if self._rosout is not None:
            self._rosout.close()
        self._time_source.detach_node()
        for end in [*self.publishers, *self.subscriptions, *self.clients, *self.services]:
            getattr(self, f"destroy_{type(end).__name__.lower()}")(end)
        for entity in self.entities():
            self._remove(entity)
        self._graph.remove_node(self)
        if self.executor is not None:
            self.executor.remove_node(self)
        self._handle.destroy_when_not_in_use()

    # --- parts ---

    def _named(self, name: str, namespace: str) -> tuple[str, str]:
        """Name and namespace after the rules of the command line. Raises for those that are not valid."""
        validate_node_name(name)
        namespace = namespace if namespace.startswith("/") else f"/{namespace}"
        validate_namespace(namespace)
        new_name, new_space = name, namespace
        for arguments in reversed(self._arguments):
            new_name, new_space = arguments.node_name(name), arguments.namespace(name, new_space)
        return new_name, new_space

    def _overrides(self, given: Sequence[Parameter]) -> dict[str, Parameter]:
        found: dict[str, Parameter] = {}
        arguments: Arguments
        for arguments in reversed(self._arguments):
            values = arguments.values(self.get_fully_qualified_name())
            found |= {name: Parameter(name, value=value) for name, value in values.items()}
        return found | {one.name: one for one in given}

    def _resolved(self, name: str, *, only_expand: bool = False) -> str:
        full = expanded(name, self._name, self._namespace)
        if only_expand:
            return full
        remapped = (one.remapped(full, self._name, self._namespace) for one in self._arguments)
        return next((one for one in remapped if one is not None), full)

    def _endpoint_name(self, name: str, *, is_service: bool = False) -> str:
        """The full name of an endpoint. Raises for one that is not valid."""
        with self._handle:
            validate_topic_name(name, is_service=is_service)
            full = self._resolved(name)
            validate_full_topic_name(full, is_service=is_service)
            return full

    def _owned(self, entity: E) -> E:
        """Make this node the owner of a new entity."""
        entity.belong_to(self)
        if entity.callback_group is not None:
            entity.callback_group.add_entity(entity)
        self._endpoints[type(entity)].append(entity)
        return entity

    def _remove(self, end: Any) -> bool:
        ends = self._endpoints[type(end)]
        if not any(one is end for one in ends):
            return False
        self._endpoints[type(end)] = [one for one in ends if one is not end]
        end.destroy()
        return True


def _profile(qos_or_depth: QoSProfile | int) -> QoSProfile:
    if isinstance(qos_or_depth, QoSProfile):
        return qos_or_depth
    if not isinstance(qos_or_depth, int):
        raise TypeError(f"Expected QoSProfile or int, but received {type(qos_or_depth)!r}")
    if qos_or_depth < 0:
        raise ValueError("history depth must be greater than or equal to zero")
    return QoSProfile(depth=qos_or_depth)
