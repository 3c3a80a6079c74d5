"""Lists names of parameters by the parts that dots separate."""

from __future__ import annotations

from collections.abc import Iterable

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.rclpy.parameter import PARAMETER_SEPARATOR_STRING

__all__ = ["listed"]


def listed(declared: Iterable[str], prefixes: list[str], depth: int) -> ros_types.ListParametersResult:
    """Those of the declared names that begin with a prefix, and what comes before their last dots.

    Args:
        declared: Names.
        prefixes: What comes before a dot, or whole names; empty for all names.
        depth: Names have fewer dots than this after the prefix; 0 stands for any number.

    Raises TypeError for other types, and ValueError for a negative depth.
    """
    if not isinstance(prefixes, list):
        raise TypeError("The prefixes argument must be a list")
    if not all(isinstance(one, str) for one in prefixes):
        raise TypeError("All prefixes must be instances of type str")
    if not isinstance(depth, int):
        raise TypeError("The depth must be instance of type int")
    if depth < 0:
        raise ValueError("The depth must be greater than or equal to zero")

    def is_listed(name: str) -> bool:
        if not prefixes:
            return not depth or name.count(PARAMETER_SEPARATOR_STRING) < depth
        starts = [f"{one}{PARAMETER_SEPARATOR_STRING}" for one in prefixes]
        rests = [name.removeprefix(one) for one in starts if name.startswith(one)]
        return name in prefixes or any(not depth or one.count(PARAMETER_SEPARATOR_STRING) < depth for one in rests)

    names = [name for name in declared if is_listed(name)]
    heads = (name.rpartition(PARAMETER_SEPARATOR_STRING)[0] for name in names)
    return ros_types.ListParametersResult(names=names, prefixes=list(dict.fromkeys(filter(None, heads))))
