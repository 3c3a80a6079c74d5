"""What clients and services of a service type have in common."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic

from thymio_sim_ros.portable_ros.graph.entity import Entity
from thymio_sim_ros.portable_ros.messages.message_class import Service, SrvRequestT, SrvResponseT
from thymio_sim_ros.portable_ros.rclpy.callback_groups import CallbackGroup
from thymio_sim_ros.portable_ros.rclpy.qos import QoSProfile

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
