"""Packages that only some playgrounds need."""

from __future__ import annotations

import importlib
from types import ModuleType

from thymio_sim_ros.sim.model.fields import FieldError

__all__ = ["imported"]


def imported(name: str, package: str, key: str) -> ModuleType:
    """Import a module of an optional package. Raises FieldError, with this key, if it is missing."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise FieldError(
            key, f"an image that needs the missing package {package}", f"`pip install {package}`"
        ) from error
