"""The services: two of them have a twin in `std_srvs`."""

from __future__ import annotations

from thymio_sim_ros.ros.compat.absent_types import AbsentType, absent

__all__ = ["AddTwoInts", "SetBool", "Trigger"]

AddTwoInts: AbsentType = absent("example_interfaces.srv", "AddTwoInts")
SetBool: AbsentType = absent("example_interfaces.srv", "SetBool", twin="std_srvs.srv.SetBool")
Trigger: AbsentType = absent("example_interfaces.srv", "Trigger", twin="std_srvs.srv.Trigger")
