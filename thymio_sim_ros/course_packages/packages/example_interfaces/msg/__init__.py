"""The messages: all but one have a twin in `std_msgs`."""

from __future__ import annotations

from thymio_sim_ros.ros.compat.absent_types import AbsentType, absent

_NUMBERS = ("Float32", "Float64", "Int8", "Int16", "Int32", "Int64", "UInt8", "UInt16", "UInt32", "UInt64")
_TWINS = (
    *("Bool", "Byte", "ByteMultiArray", "Char", "Empty", "MultiArrayDimension", "MultiArrayLayout", "String"),
    *(number + shape for number in _NUMBERS for shape in ("", "MultiArray")),
)

__all__ = ["WString", *_TWINS]

WString: AbsentType = absent("example_interfaces.msg", "WString")
for _name in _TWINS:
    globals()[_name] = absent("example_interfaces.msg", _name, twin=f"std_msgs.msg.{_name}")
