"""Quality of service of endpoints, and whether two of them are compatible."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from enum import Enum, IntEnum
from typing import Any, ClassVar

from thymio_sim_ros.portable_ros.rclpy.duration import Duration
from thymio_sim_ros.portable_ros.rclpy_parts.checked_field import checked_field
from thymio_sim_ros.portable_ros.rclpy_parts.qos_policies import DurabilityPolicy as DurabilityPolicy
from thymio_sim_ros.portable_ros.rclpy_parts.qos_policies import HistoryPolicy as HistoryPolicy
from thymio_sim_ros.portable_ros.rclpy_parts.qos_policies import LivelinessPolicy as LivelinessPolicy
from thymio_sim_ros.portable_ros.rclpy_parts.qos_policies import QoSDurabilityPolicy as QoSDurabilityPolicy
from thymio_sim_ros.portable_ros.rclpy_parts.qos_policies import QoSHistoryPolicy as QoSHistoryPolicy
from thymio_sim_ros.portable_ros.rclpy_parts.qos_policies import QoSLivelinessPolicy as QoSLivelinessPolicy
from thymio_sim_ros.portable_ros.rclpy_parts.qos_policies import QoSPolicyEnum as QoSPolicyEnum
from thymio_sim_ros.portable_ros.rclpy_parts.qos_policies import QoSPolicyKind as QoSPolicyKind
from thymio_sim_ros.portable_ros.rclpy_parts.qos_policies import QoSReliabilityPolicy as QoSReliabilityPolicy
from thymio_sim_ros.portable_ros.rclpy_parts.qos_policies import ReliabilityPolicy as ReliabilityPolicy
from thymio_sim_ros.portable_ros.rclpy_parts.qos_policies import qos_policy_name_from_kind as qos_policy_name_from_kind


class InvalidQoSProfileException(Exception):
    """The arguments of a profile do not make one."""

    def __init__(self, *args: Any) -> None:
        super().__init__("Invalid QoSProfile", *args)


_BEST_AVAILABLE_NS = 2**63 - 2
DeadlineBestAvailable = Duration(nanoseconds=_BEST_AVAILABLE_NS)
LivelinessLeaseDurationeBestAvailable = Duration(nanoseconds=_BEST_AVAILABLE_NS)

_DEFAULT_DEPTH = 10
_ZERO_DEPTH = (
    "A zero depth with KEEP_LAST doesn't make sense; no data could be stored. This will be interpreted as"
    " SYSTEM_DEFAULT"
)
_POLICIES: dict[str, type[Any]] = {
    "history": HistoryPolicy,
    "depth": int,
    "reliability": ReliabilityPolicy,
    "durability": DurabilityPolicy,
    "lifespan": Duration,
    "deadline": Duration,
    "liveliness": LivelinessPolicy,
    "liveliness_lease_duration": Duration,
    "avoid_ros_namespace_conventions": bool,
}


class QoSProfile:
    """The policies of an endpoint. Raises InvalidQoSProfileException without history or depth."""

    __slots__: ClassVar[tuple[str, ...]] = tuple(f"_{name}" for name in _POLICIES)
    history: HistoryPolicy
    depth: int
    reliability: ReliabilityPolicy
    durability: DurabilityPolicy
    lifespan: Duration
    deadline: Duration
    liveliness: LivelinessPolicy
    liveliness_lease_duration: Duration
    avoid_ros_namespace_conventions: bool

    def __init__(self, **kwargs: Any) -> None:
        if not kwargs.keys() <= _POLICIES.keys():
            raise AssertionError(f"Invalid arguments passed to constructor: {kwargs.keys()!r}")
        if "history" not in kwargs and "depth" not in kwargs:
            raise InvalidQoSProfileException("History and/or depth settings are required.")
        history = kwargs.get("history", HistoryPolicy.KEEP_LAST)
        if history == HistoryPolicy.KEEP_LAST and "depth" not in kwargs:
            raise InvalidQoSProfileException("History set to KEEP_LAST without a depth setting.")
        self.history = history
        self.depth = kwargs.get("depth", _DEFAULT_DEPTH)
        self.reliability = kwargs.get("reliability", ReliabilityPolicy.RELIABLE)
        self.durability = kwargs.get("durability", DurabilityPolicy.VOLATILE)
        self.lifespan = kwargs.get("lifespan", Duration())
        self.deadline = kwargs.get("deadline", Duration())
        self.liveliness = kwargs.get("liveliness", LivelinessPolicy.SYSTEM_DEFAULT)
        self.liveliness_lease_duration = kwargs.get("liveliness_lease_duration", Duration())
        self.avoid_ros_namespace_conventions = kwargs.get("avoid_ros_namespace_conventions", False)

    def __setattr__(self, name: str, value: Any) -> None:
        if name == "depth" and value == 0 and self.history == HistoryPolicy.KEEP_LAST:
            warnings.warn(_ZERO_DEPTH, stacklevel=2)
        super().__setattr__(name, value)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, QoSProfile) and all(getattr(self, one) == getattr(other, one) for one in _POLICIES)

    __hash__ = None  # type: ignore[assignment]  # profiles can be changed

    def __str__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{one}={getattr(self, one)}' for one in _POLICIES)})"

    @property
    def kept(self) -> int | None:
        """How many messages wait at most; None without a limit."""
        if self.history == HistoryPolicy.KEEP_ALL:
            return None
        return self.depth if self.depth > 0 else 1


def _converted(kind: type[Any]) -> Callable[[Any], Any]:
    """The conversion of what is assigned to a policy: the values of policies may be given as numbers."""
    if issubclass(kind, IntEnum):
        return lambda value: kind(value) if isinstance(value, int) else value
    return lambda value: value


for _name, _kind in _POLICIES.items():
    setattr(QoSProfile, _name, checked_field(_name, _kind, _converted(_kind)))


def _last(depth: int, **policies: Any) -> QoSProfile:
    return QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=depth, **policies)


qos_profile_unknown = QoSProfile(
    history=HistoryPolicy.UNKNOWN,
    depth=0,
    reliability=ReliabilityPolicy.UNKNOWN,
    durability=DurabilityPolicy.UNKNOWN,
    liveliness=LivelinessPolicy.UNKNOWN,
)
qos_profile_default = _last(_DEFAULT_DEPTH)
qos_profile_system_default = QoSProfile(
    history=HistoryPolicy.SYSTEM_DEFAULT,
    depth=0,
    reliability=ReliabilityPolicy.SYSTEM_DEFAULT,
    durability=DurabilityPolicy.SYSTEM_DEFAULT,
)
qos_profile_sensor_data = _last(5, reliability=ReliabilityPolicy.BEST_EFFORT)
qos_profile_services_default = _last(_DEFAULT_DEPTH)
qos_profile_parameters = _last(1000)
qos_profile_parameter_events = _last(1000)
qos_profile_best_available = _last(
    _DEFAULT_DEPTH,
    reliability=ReliabilityPolicy.BEST_AVAILABLE,
    durability=DurabilityPolicy.BEST_AVAILABLE,
    deadline=DeadlineBestAvailable,
    liveliness=LivelinessPolicy.BEST_AVAILABLE,
    liveliness_lease_duration=LivelinessLeaseDurationeBestAvailable,
)
qos_profile_action_status_default = _last(1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class QoSPresetProfiles(Enum):
    """Profiles by their names."""

    UNKNOWN = qos_profile_unknown
    DEFAULT = qos_profile_default
    SYSTEM_DEFAULT = qos_profile_system_default
    SENSOR_DATA = qos_profile_sensor_data
    SERVICES_DEFAULT = qos_profile_services_default
    PARAMETERS = qos_profile_parameters
    PARAMETER_EVENTS = qos_profile_parameter_events
    ACTION_STATUS_DEFAULT = qos_profile_action_status_default
    BEST_AVAILABLE = qos_profile_best_available

    @classmethod
    def short_keys(cls) -> list[str]:
        """The names of all profiles, in lower case."""
        return [name.lower() for name in cls.__members__]

    @classmethod
    def get_from_short_key(cls, name: str) -> QoSProfile:
        """The profile of a name, in any case."""
        return cls[name.upper()].value


class QoSCompatibility(Enum):
    """Whether endpoints with two profiles communicate."""

    OK = 0
    WARNING = 1
    ERROR = 2


def qos_check_compatible(publisher_qos: QoSProfile, subscription_qos: QoSProfile) -> tuple[QoSCompatibility, str]:
    """Whether a publisher and a subscription with these profiles communicate, and all reasons why not."""
    errors = [reason for _, reason in incompatibilities(publisher_qos, subscription_qos)]
    if errors:
        return QoSCompatibility.ERROR, "".join(f"ERROR: {one};" for one in errors)
    doubts = _doubts(publisher_qos, subscription_qos)
    return (QoSCompatibility.WARNING if doubts else QoSCompatibility.OK), "".join(f"WARNING: {one};" for one in doubts)


def incompatibilities(published: QoSProfile, wanted: QoSProfile) -> list[tuple[QoSPolicyKind, str]]:
    """The policies that do not fit, each with the reason."""
    found: list[tuple[QoSPolicyKind, str]] = []
    if (published.reliability, wanted.reliability) == (ReliabilityPolicy.BEST_EFFORT, ReliabilityPolicy.RELIABLE):
        found.append((QoSPolicyKind.RELIABILITY, "Best effort publisher and reliable subscription"))
    if (published.durability, wanted.durability) == (DurabilityPolicy.VOLATILE, DurabilityPolicy.TRANSIENT_LOCAL):
        found.append((QoSPolicyKind.DURABILITY, "Volatile publisher and transient local subscription"))
    offered, needed = published.deadline, wanted.deadline
    if needed != Duration() and offered == Duration():
        found.append((QoSPolicyKind.DEADLINE, "Subscription has a deadline, but publisher does not"))
    elif needed != Duration() and needed < offered:
        found.append((QoSPolicyKind.DEADLINE, "Subscription deadline is less than publisher deadline"))
    manual = LivelinessPolicy.MANUAL_BY_TOPIC
    if (published.liveliness, wanted.liveliness) == (LivelinessPolicy.AUTOMATIC, manual):
        reason = "Publisher's liveliness is automatic and subscription's is manual by topic"
        found.append((QoSPolicyKind.LIVELINESS, reason))
    offered, needed = published.liveliness_lease_duration, wanted.liveliness_lease_duration
    if needed != Duration() and offered == Duration():
        reason = "Subscription has a liveliness lease duration, but publisher does not"
        found.append((QoSPolicyKind.LIVELINESS, reason))
    elif needed != Duration() and needed < offered:
        found.append((QoSPolicyKind.LIVELINESS, "Subscription liveliness lease duration is less than publisher"))
    return found


def _doubts(published: QoSProfile, wanted: QoSProfile) -> list[str]:
    """What the profiles leave to the middleware."""
    found = []
    open_values = ("SYSTEM_DEFAULT", "UNKNOWN")
    for policy, strict, weak in (
        ("reliability", ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT),
        ("durability", DurabilityPolicy.TRANSIENT_LOCAL, DurabilityPolicy.VOLATILE),
    ):
        offered, needed = getattr(published, policy), getattr(wanted, policy)
        if offered.name in open_values and needed == strict:
            kind = strict.name.capitalize().replace("_", " ")
            found.append(f"{kind} subscription, but publisher is {offered.short_key}")
        elif offered == weak and needed.name in open_values:
            kind = weak.name.capitalize().replace("_", " ")
            found.append(f"{kind} publisher, but subscription is {needed.short_key}")
        elif offered.name in open_values and needed.name in open_values:
            found.append(f"Publisher {policy} is {offered.short_key} and subscription {policy} is {needed.short_key}")
    offered, needed = published.liveliness, wanted.liveliness
    if offered.name in open_values and needed.name in open_values:
        found.append(f"Publisher liveliness is {offered.short_key} and subscription liveliness is {needed.short_key}")
    elif offered == LivelinessPolicy.AUTOMATIC and needed.name in open_values:
        found.append(f"Publisher's liveliness is automatic, but subscription's is {needed.short_key}")
    elif offered.name in open_values and needed == LivelinessPolicy.MANUAL_BY_TOPIC:
        found.append(f"Subscription's liveliness is manual by topic, but publisher's is {offered.short_key}")
    return found
