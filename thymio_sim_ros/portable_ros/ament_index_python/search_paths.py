"""The folders of installed packages."""

from __future__ import annotations

from thymio_sim_ros.portable_ros.source_packages import prefixes

__all__ = ["get_search_paths"]


def get_search_paths() -> list[str]:
    """The folders of `AMENT_PREFIX_PATH`, and that of Python; without the variable, there is no error."""
    return list(map(str, prefixes()))
