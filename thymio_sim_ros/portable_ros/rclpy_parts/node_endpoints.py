"""Makes and destroys what a node has: publishers, subscriptions, clients, services, timers, guard conditions."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any, Literal, TypeVar, overload

from thymio_sim_ros.portable_ros.graph.endpoint_events import EndpointEvents
from thymio_sim_ros.portable_ros.graph.liveliness import Lease
from thymio_sim_ros.portable_ros.messages.message_class import Message, MsgT, SrvRequestT, SrvResponseT
from thymio_sim_ros.portable_ros.messages.message_class import Service as ServiceType
from thymio_sim_ros.portable_ros.rclpy.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup
from thymio_sim_ros.portable_ros.rclpy.client import Client
from thymio_sim_ros.portable_ros.rclpy.clock import Clock
from thymio_sim_ros.portable_ros.rclpy.clock_type import ClockType
from thymio_sim_ros.portable_ros.rclpy.constants import S_TO_NS
from thymio_sim_ros.portable_ros.rclpy.duration import Duration
from thymio_sim_ros.portable_ros.rclpy.event_handler import (
    PublisherEventCallbacks,
    SubscriptionEventCallbacks,
)
from thymio_sim_ros.portable_ros.rclpy.guard_condition import GuardCondition
from thymio_sim_ros.portable_ros.rclpy.logging import get_logger
from thymio_sim_ros.portable_ros.rclpy.publisher import Publisher
from thymio_sim_ros.portable_ros.rclpy.qos import (
    DeadlineBestAvailable,
    LivelinessLeaseDurationeBestAvailable,
    LivelinessPolicy,
    QoSProfile,
    qos_profile_services_default,
)
from thymio_sim_ros.portable_ros.rclpy.qos_overriding_options import QoSOverridingOptions, _declare_qos_parameters
from thymio_sim_ros.portable_ros.rclpy.service import Service
from thymio_sim_ros.portable_ros.rclpy.subscription import MessageInfo, Subscription
from thymio_sim_ros.portable_ros.rclpy.timer import Rate, Timer
from thymio_sim_ros.portable_ros.rclpy.type_support import check_is_valid_msg_type, check_is_valid_srv_type
from thymio_sim_ros.portable_ros.rclpy_parts.node_entities import NodeEntities
from thymio_sim_ros.portable_ros.rclpy_parts.service_entity import ServiceDescription

__all__ = ["NodeEndpoints"]

C = TypeVar("C", bound=Client[Any, Any])
S = TypeVar("S", bound=Service)


class NodeEndpoints(NodeEntities):
    """The part of a node that makes and destroys publishers, subscriptions, clients, services, timers and guards."""

    def create_publisher(
        self,
        msg_type: type[MsgT],
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: PublisherEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        publisher_class: type[Publisher[MsgT]] = Publisher,
    ) -> Publisher[MsgT]:
        """Publish a topic. Raises InvalidTopicNameException and errors about type and profile."""
        profile = _profile(qos_profile)
        full = self._endpoint_name(topic)
        _declare_qos_parameters(Publisher, self, full, profile, qos_overriding_options or QoSOverridingOptions(()))
        check_is_valid_msg_type(msg_type)
        self._require_context("Failed to create publisher")
        self._graph.require_topic_type(full, msg_type, self._context)
        group = callback_group or self._default_callback_group
        events = self._events(event_callbacks or PublisherEventCallbacks(), group, topic)
        self._watch_deadline(events, profile, group)
        self._watch_liveliness(events, profile, group)
        made = publisher_class(self._context, msg_type, topic, full, profile, events, self._logger.name)
        self._entities[Publisher].append(made)
        made.handle.on_release(lambda: self._graph.remove_publisher(made))
        self._graph.add_publisher(made)
        return made

    @overload
    def create_subscription(
        self,
        msg_type: type[MsgT],
        topic: str,
        callback: Callable[[MsgT], object],
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: Literal[False] = False,
    ) -> Subscription: ...
    @overload
    def create_subscription(
        self,
        msg_type: type[MsgT],
        topic: str,
        callback: Callable[[MsgT, MessageInfo], object],
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: Literal[False] = False,
    ) -> Subscription: ...
    @overload
    def create_subscription(
        self,
        msg_type: type[Message],
        topic: str,
        callback: Callable[[bytes], object] | Callable[[bytes, MessageInfo], object],
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool,
    ) -> Subscription: ...
    def create_subscription(
        self,
        msg_type: type[Message],
        topic: str,
        callback: Callable[..., object],
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool = False,
    ) -> Subscription:
        """Subscribe to a topic; `raw`: the callback gets bytes. Raises as `create_publisher`."""
        profile = _profile(qos_profile)
        full = self._endpoint_name(topic)
        _declare_qos_parameters(Subscription, self, full, profile, qos_overriding_options or QoSOverridingOptions(()))
        check_is_valid_msg_type(msg_type)
        self._require_context("Failed to create subscription")
        self._graph.require_topic_type(full, msg_type, self._context)
        group = callback_group or self._default_callback_group
        events = self._events(event_callbacks or SubscriptionEventCallbacks(), group, topic)
        self._watch_deadline(events, profile, group)
        made = Subscription(msg_type, topic, full, callback, group, profile, raw, events, self._logger.name)
        self._owned(made)
        made.handle.on_release(lambda: self._graph.remove_subscription(made))
        self._graph.add_subscription(made)
        return made

    def create_client(
        self,
        srv_type: type[ServiceType[SrvRequestT, SrvResponseT]],
        srv_name: str,
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Client[SrvRequestT, SrvResponseT]:
        """Call a service. Raises InvalidServiceNameException and errors about the type."""
        self._require_context("failed to create client")
        return self._add_client(Client(self._service_description(srv_type, srv_name, qos_profile, callback_group)))

    def create_service(
        self,
        srv_type: type[ServiceType[SrvRequestT, SrvResponseT]],
        srv_name: str,
        callback: Callable[[SrvRequestT, SrvResponseT], SrvResponseT | Awaitable[SrvResponseT]],
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Service:
        """Offer a service. Raises InvalidServiceNameException and errors about the type."""
        self._require_context("failed to create service")
        of = self._service_description(srv_type, srv_name, qos_profile, callback_group)
        return self._add_service(Service(of, callback))

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
        self._context.require_ok("failed to create timer")
        group = callback_group or self._default_callback_group
        made = self._owned(
            Timer(callback, group, period_ns, clock or self._clock, context=self._context, autostart=autostart)
        )
        self._wake_executor()
        return made

    def create_guard_condition(
        self, callback: Callable[..., Any], callback_group: CallbackGroup | None = None
    ) -> GuardCondition:
        """Call back when it is triggered."""
        self._context.require_ok("failed to create guard_condition")
        return self._owned(GuardCondition(callback, callback_group or self._default_callback_group, self._context))

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """Sleep so many times per second. Raises ValueError for a frequency that is not positive."""
        if frequency <= 0:
            raise ValueError("frequency must be > 0")
        # A group of its own: other callbacks do not delay it.
        timer = self.create_timer(1.0 / frequency, None, MutuallyExclusiveCallbackGroup(), clock)
        return Rate(timer, context=self._context)

    def destroy_publisher(self, publisher: Publisher[Any]) -> bool:
        """Remove a publisher; return whether it was one of this node."""
        return isinstance(publisher, Publisher) and self._remove_with_events(publisher)

    def destroy_subscription(self, subscription: Subscription) -> bool:
        """Remove a subscription; return whether it was one of this node."""
        return isinstance(subscription, Subscription) and self._remove_with_events(subscription)

    def destroy_client(self, client: Client[Any, Any]) -> bool:
        """Remove a client; return whether it was one of this node."""
        return isinstance(client, Client) and self._remove(client)

    def destroy_service(self, service: Service) -> bool:
        """Remove a service; return whether it was one of this node."""
        return isinstance(service, Service) and self._remove(service)

    def destroy_timer(self, timer: Timer) -> bool:
        """Remove a timer; return whether it was one of this node."""
        return isinstance(timer, Timer) and self._remove(timer)

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        """Remove a guard condition; return whether it was one of this node."""
        return isinstance(guard, GuardCondition) and self._remove(guard)

    def destroy_rate(self, rate: Rate) -> bool:
        """Remove a rate and its timer."""
        is_own = self.destroy_timer(rate._timer)
        rate.destroy()
        return is_own

    def _add_client(self, made: C) -> C:
        """Make this node the owner of a new client."""
        self._owned(made)
        made.handle.on_release(lambda: self._graph.remove_client(made))
        self._graph.add_client(made)
        return made

    def _add_service(self, made: S) -> S:
        """Make this node the owner of a new service."""
        self._owned(made)
        made.handle.on_release(lambda: self._graph.remove_service(made))
        self._graph.add_service(made)
        return made

    def _service_description(
        self,
        srv_type: type[ServiceType[SrvRequestT, SrvResponseT]],
        srv_name: str,
        qos_profile: QoSProfile,
        callback_group: CallbackGroup | None,
    ) -> ServiceDescription[SrvRequestT, SrvResponseT]:
        """What a client or a service is made of. Raises InvalidServiceNameException and errors about the type."""
        check_is_valid_srv_type(srv_type)
        full = self._endpoint_name(srv_name, is_service=True)
        self._graph.require_service_type(full, srv_type, self._context)
        group = callback_group or self._default_callback_group
        return ServiceDescription(srv_type, srv_name, full, qos_profile, group, self._logger.name)

    def _events(
        self, callbacks: PublisherEventCallbacks | SubscriptionEventCallbacks, group: CallbackGroup, topic: str
    ) -> EndpointEvents:
        """The events of a new endpoint, whose handlers belong to this node."""
        handlers = callbacks.handlers(group, topic, get_logger(self._logger.name).warn)
        for handler in handlers.values():
            self._owned(handler)
        return EndpointEvents(handlers)

    def _watch_deadline(self, events: EndpointEvents, profile: QoSProfile, group: CallbackGroup) -> None:
        """Have missed deadlines reported, if a profile has a deadline and a callback asks for them."""
        deadline = profile.deadline
        if events.asks_for_deadlines and Duration() < deadline < DeadlineBestAvailable:
            events.watch(self._hidden_timer(events.report_missed, deadline, group))

    def _watch_liveliness(self, events: EndpointEvents, profile: QoSProfile, group: CallbackGroup) -> None:
        """Have the end of a publisher's liveliness reported, if it asserts that itself."""
        duration = profile.liveliness_lease_duration
        is_manual = profile.liveliness == LivelinessPolicy.MANUAL_BY_TOPIC
        if is_manual and Duration() < duration < LivelinessLeaseDurationeBestAvailable:
            events.lease = Lease()
            events.lease.timer = self._hidden_timer(events.report_lost, duration, group)

    def _hidden_timer(self, callback: Callable[[], None], period: Duration, group: CallbackGroup) -> Timer:
        """A timer that runs after its `reset`, on steady time, and is not listed."""
        clock = Clock(clock_type=ClockType.STEADY_TIME)
        timer = self._owned(Timer(callback, group, period.nanoseconds, clock, autostart=False))
        timer.is_part = True
        return timer


def _profile(qos_or_depth: QoSProfile | int) -> QoSProfile:
    if isinstance(qos_or_depth, QoSProfile):
        return qos_or_depth
    if not isinstance(qos_or_depth, int):
        raise TypeError(f"Expected QoSProfile or int, but received {type(qos_or_depth)!r}")
    if qos_or_depth < 0:
        raise ValueError("history depth must be greater than or equal to zero")
    return QoSProfile(depth=qos_or_depth)
