"""What clients and services of a service type have in common."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic

from thymio_sim_ros.portable_ros.graph.entity import Entity
from thymio_sim_ros.portable_ros.messages.message_class import Message, Service, SrvRequestT, SrvResponseT
from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import require_argument
from thymio_sim_ros.portable_ros.rclpy.callback_groups import CallbackGroup
from thymio_sim_ros.portable_ros.rclpy.clock import Clock
from thymio_sim_ros.portable_ros.rclpy.qos import QoSProfile
from thymio_sim_ros.portable_ros.rclpy.service_introspection import ServiceEvents, ServiceIntrospectionState

__all__ = ["ServiceDescription", "ServiceEntity"]


@dataclass(frozen=True, slots=True)
class ServiceDescription(Generic[SrvRequestT, SrvResponseT]):
    """What a client or a service is made of; the program gave the name `srv_name`."""

    srv_type: type[Service[SrvRequestT, SrvResponseT]]
    srv_name: str
    full_name: str
    qos_profile: QoSProfile
    callback_group: CallbackGroup
    logger_name: str


class ServiceEntity(Entity, Generic[SrvRequestT, SrvResponseT]):
    """A client or a service."""

    def __init__(self, of: ServiceDescription[SrvRequestT, SrvResponseT]) -> None:
        super().__init__(of.callback_group)
        self.srv_type, self.srv_name, self.qos_profile = of.srv_type, of.srv_name, of.qos_profile
        self._full_name, self._logger_name = of.full_name, of.logger_name
        self._events: ServiceEvents | None = None

    def configure_introspection(
        self, clock: Clock, service_event_qos_profile: QoSProfile, introspection_state: ServiceIntrospectionState
    ) -> None:
        """Publish the events of this end of the service from now on, stamped by a clock; `OFF` ends it.

        Raises TypeError for arguments of other types.
        """
        with self._handle:
            for found, kind in (
                (clock, Clock),
                (service_event_qos_profile, QoSProfile),
                (introspection_state, ServiceIntrospectionState),
            ):
                require_argument("configure_introspection", found, kind)
            if self._events is not None:
                self._events.destroy()
                self._events = None
            if introspection_state is not ServiceIntrospectionState.OFF:
                self._events = ServiceEvents(
                    self.node,
                    self.srv_type,
                    self._full_name,
                    clock,
                    service_event_qos_profile,
                    has_contents=introspection_state is ServiceIntrospectionState.CONTENTS,
                )

    def destroy(self) -> None:
        """Release the end, with its events. Nodes have `destroy_client` and `destroy_service`."""
        if self._events is not None:
            self._events.destroy()
        super().destroy()

    def _report(self, event_type: int, client: object, sequence: int, **content: Message) -> None:
        """Publish an event if that is configured."""
        if (events := self._events) is not None:
            events.publish(event_type, client, sequence, **content)

    @property
    def service_name(self) -> str:
        """The full name of the service."""
        with self._handle:
            return self._full_name

    @property
    def logger_name(self) -> str:
        """The name of the log of the node."""
        with self._handle:
            return self._logger_name
