"""The files of the index: each is named by a type of resources and a resource, such as `packages/rclpy`."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from thymio_sim_ros.portable_ros.ament_index_python.search_paths import get_search_paths
from thymio_sim_ros.portable_ros.source_packages import INDEX

__all__ = ["get_resource", "get_resources", "has_resource"]


def get_resource(resource_type: str, resource_name: str) -> tuple[str, str]:
    """The content of a resource, and the folder of its package. Raises LookupError if there is none."""
    prefix = has_resource(resource_type, resource_name)
    if prefix is False:
        raise LookupError(f"Could not find the resource '{resource_name}' of type '{resource_type}'")
    return Path(prefix, INDEX, resource_type, resource_name).read_text(encoding="utf-8"), prefix


def get_resources(resource_type: str) -> dict[str, str]:
    """The folders of all resources of a type by their names; the first folder of a name counts."""
    found: dict[str, str] = {}
    for prefix in get_search_paths():
        folder = Path(prefix, INDEX, resource_type)
        for file in sorted(folder.iterdir()) if folder.is_dir() else ():
            if file.is_file() and not file.name.startswith("."):
                found.setdefault(file.name, prefix)
    return found


def has_resource(resource_type: str, resource_name: str) -> str | Literal[False]:
    """The folder of the package of a resource, False without one."""
    files = ((prefix, Path(prefix, INDEX, resource_type, resource_name)) for prefix in get_search_paths())
    return next((prefix for prefix, file in files if file.is_file()), False)
