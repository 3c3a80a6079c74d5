"""The index of packages: where the files of a package are."""

from __future__ import annotations

from thymio_sim_ros.portable_ros.ament_index_python.packages import (
    PackageNotFoundError,
    get_package_prefix,
    get_package_share_directory,
    get_package_share_path,
    get_packages_with_prefixes,
)
from thymio_sim_ros.portable_ros.ament_index_python.resources import get_resource, get_resources, has_resource
from thymio_sim_ros.portable_ros.ament_index_python.search_paths import get_search_paths

__all__ = [
    "PackageNotFoundError",
    "get_package_prefix",
    "get_package_share_directory",
    "get_package_share_path",
    "get_packages_with_prefixes",
    "get_resource",
    "get_resources",
    "get_search_paths",
    "has_resource",
]
