"""The states of lifecycle nodes and the transitions between them, as rcl has them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from enum import Enum
from typing import NamedTuple

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import RCLError
from thymio_sim_ros.portable_ros.rclpy.logging import get_logger

__all__ = ["STATES", "TRANSITIONS", "LifecycleState", "StateMachine", "Transition", "TransitionCallbackReturn"]

_Ids = ros_types.Transition


class TransitionCallbackReturn(Enum):
    """What a callback of a transition returns."""

    SUCCESS = _Ids.TRANSITION_CALLBACK_SUCCESS
    FAILURE = _Ids.TRANSITION_CALLBACK_FAILURE
    ERROR = _Ids.TRANSITION_CALLBACK_ERROR

    def __int__(self) -> int:
        return int(self.value)

    def to_label(self) -> str:
        """The label of the transition that follows."""
        return f"transition_{self.name.lower()}"


class LifecycleState(NamedTuple):
    """A state."""

    label: str
    state_id: int


class Transition(NamedTuple):
    """A transition between two states."""

    id: int
    label: str
    start: LifecycleState
    goal: LifecycleState


_UNKNOWN = LifecycleState("unknown", ros_types.State.PRIMARY_STATE_UNKNOWN)
_UNCONFIGURED = LifecycleState("unconfigured", ros_types.State.PRIMARY_STATE_UNCONFIGURED)
_INACTIVE = LifecycleState("inactive", ros_types.State.PRIMARY_STATE_INACTIVE)
_ACTIVE = LifecycleState("active", ros_types.State.PRIMARY_STATE_ACTIVE)
_FINALIZED = LifecycleState("finalized", ros_types.State.PRIMARY_STATE_FINALIZED)
_CONFIGURING = LifecycleState("configuring", ros_types.State.TRANSITION_STATE_CONFIGURING)
_CLEANING_UP = LifecycleState("cleaningup", ros_types.State.TRANSITION_STATE_CLEANINGUP)
_SHUTTING_DOWN = LifecycleState("shuttingdown", ros_types.State.TRANSITION_STATE_SHUTTINGDOWN)
_ACTIVATING = LifecycleState("activating", ros_types.State.TRANSITION_STATE_ACTIVATING)
_DEACTIVATING = LifecycleState("deactivating", ros_types.State.TRANSITION_STATE_DEACTIVATING)
_PROCESSING_ERROR = LifecycleState("errorprocessing", ros_types.State.TRANSITION_STATE_ERRORPROCESSING)

STATES = (
    _UNKNOWN,
    _UNCONFIGURED,
    _INACTIVE,
    _ACTIVE,
    _FINALIZED,
    _CONFIGURING,
    _CLEANING_UP,
    _SHUTTING_DOWN,
    _ACTIVATING,
    _DEACTIVATING,
    _PROCESSING_ERROR,
)


def _ends(
    first_id: int, through: LifecycleState, success: LifecycleState, failure: LifecycleState, error: LifecycleState
) -> Iterator[Transition]:
    """The transitions that follow a callback; their ids are in the order of its results."""
    goals = (success, failure, error)
    for number, (result, goal) in enumerate(zip(TransitionCallbackReturn, goals, strict=True)):
        yield Transition(first_id + number, result.to_label(), through, goal)


TRANSITIONS = (
    Transition(_Ids.TRANSITION_CONFIGURE, "configure", _UNCONFIGURED, _CONFIGURING),
    *_ends(_Ids.TRANSITION_ON_CONFIGURE_SUCCESS, _CONFIGURING, _INACTIVE, _UNCONFIGURED, _PROCESSING_ERROR),
    Transition(_Ids.TRANSITION_CLEANUP, "cleanup", _INACTIVE, _CLEANING_UP),
    *_ends(_Ids.TRANSITION_ON_CLEANUP_SUCCESS, _CLEANING_UP, _UNCONFIGURED, _INACTIVE, _PROCESSING_ERROR),
    Transition(_Ids.TRANSITION_ACTIVATE, "activate", _INACTIVE, _ACTIVATING),
    *_ends(_Ids.TRANSITION_ON_ACTIVATE_SUCCESS, _ACTIVATING, _ACTIVE, _INACTIVE, _PROCESSING_ERROR),
    Transition(_Ids.TRANSITION_DEACTIVATE, "deactivate", _ACTIVE, _DEACTIVATING),
    *_ends(_Ids.TRANSITION_ON_DEACTIVATE_SUCCESS, _DEACTIVATING, _INACTIVE, _ACTIVE, _PROCESSING_ERROR),
    Transition(_Ids.TRANSITION_UNCONFIGURED_SHUTDOWN, "shutdown", _UNCONFIGURED, _SHUTTING_DOWN),
    Transition(_Ids.TRANSITION_INACTIVE_SHUTDOWN, "shutdown", _INACTIVE, _SHUTTING_DOWN),
    Transition(_Ids.TRANSITION_ACTIVE_SHUTDOWN, "shutdown", _ACTIVE, _SHUTTING_DOWN),
    *_ends(_Ids.TRANSITION_ON_SHUTDOWN_SUCCESS, _SHUTTING_DOWN, _FINALIZED, _FINALIZED, _PROCESSING_ERROR),
    *_ends(_Ids.TRANSITION_ON_ERROR_SUCCESS, _PROCESSING_ERROR, _UNCONFIGURED, _FINALIZED, _FINALIZED),
)


class StateMachine:
    """The state of a node, and its transitions."""

    def __init__(self, notify: Callable[[Transition], None]) -> None:
        """`notify` is called after each transition."""
        self.state = _UNCONFIGURED
        self._notify = notify

    @property
    def current_state(self) -> tuple[int, str]:
        """Id and label of the state."""
        return self.state.state_id, self.state.label

    def available(self) -> list[Transition]:
        """The transitions of the present state."""
        return [one for one in TRANSITIONS if one.start == self.state]

    def find(self, wanted: int | str) -> Transition:
        """A transition of the present state by its id or label. Raises RCLError if there is none."""
        found = next((one for one in self.available() if wanted in (one.id, one.label)), None)
        if found is None:
            get_logger("rcl_lifecycle").warning(
                f"No transition matching {wanted} found for current state {self.state.label}"
            )
            raise RCLError("Failed to trigger lifecycle state machine transition: Transition is not registered.")
        return found

    def trigger(self, wanted: int | str) -> None:
        """Change the state by a transition. Raises RCLError if the present state does not have it."""
        transition = self.find(wanted)
        self.state = transition.goal
        self._notify(transition)
