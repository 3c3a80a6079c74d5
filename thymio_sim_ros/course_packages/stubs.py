"""Stubs with which editors and type checkers find the packages of this room under the names that programs import."""

from __future__ import annotations

from pathlib import Path

__all__ = ["stubs"]

_FOLDER = Path(__file__).parent / "packages"
_TYPED = ("message_filters", "sensor_msgs_py", "tf2_geometry_msgs", "tf2_py", "tf2_ros", "tf_transformations")
"""The packages of messages have stubs of their definitions."""
_CLIENT = "from thymio_sim_ros.tf.buffer_client import BufferClient as BufferClient\n"
_HIDDEN = {
    "tf2_ros/__init__.pyi": _CLIENT,
    "tf2_ros/buffer_client.pyi": _CLIENT,
    "tf_transformations/__init__.pyi": "from thymio_sim_ros.tf.transformations import *\n",
}
"""What a package has at run time, and checkers do not see."""


def stubs() -> dict[str, str]:
    """The texts of the stubs by their paths, such as `tf2_ros/buffer.pyi`."""
    found = {}
    for source in (source for package in _TYPED for source in sorted((_FOLDER / package).rglob("*.py"))):
        path = source.relative_to(_FOLDER).with_suffix(".pyi")
        module = ".".join((__package__, "packages", *path.with_suffix("").parts)).removesuffix(".__init__")
        found[path.as_posix()] = f"from {module} import *\n" + _HIDDEN.get(path.as_posix(), "")
    return found
