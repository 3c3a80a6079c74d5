"""The message of `/tf`, and the error of answers to lookups."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from thymio_sim_ros.ros.compat.tf2_messages import TFMessage

__all__ = ["TF2Error", "TFMessage"]


@dataclass(kw_only=True)
class TF2Error:
    """Why a lookup failed; part of the services and actions of the package, never published by itself."""

    NO_ERROR: ClassVar[int] = 0
    LOOKUP_ERROR: ClassVar[int] = 1
    CONNECTIVITY_ERROR: ClassVar[int] = 2
    EXTRAPOLATION_ERROR: ClassVar[int] = 3
    INVALID_ARGUMENT_ERROR: ClassVar[int] = 4
    TIMEOUT_ERROR: ClassVar[int] = 5
    TRANSFORM_ERROR: ClassVar[int] = 6

    error: int = NO_ERROR
    error_string: str = ""
