"""Names of ROS types by their Python classes."""

from __future__ import annotations

from typing import Any

__all__ = ["type_name"]


def type_name(kind: Any) -> str:
    """The type name of a class of messages or services, such as `std_msgs/msg/Bool`."""
    package, form, *_ = kind.__module__.split(".")
    return f"{package}/{form}/{kind.__name__}"
