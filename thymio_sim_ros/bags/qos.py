"""The quality of service of a topic: as a bag has it, for its recording and for its playback."""

from __future__ import annotations

from collections.abc import Sequence

from rclpy.duration import Duration
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rosbags.interfaces import Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime

__all__ = ["of_bag", "of_playback", "of_recording"]

_DEPTH = 100
_UNKNOWN_DEPTH = 10
"""DDS does not announce the depth of publishers."""
_SECOND_NS = 1_000_000_000


def of_bag(offered: QoSProfile) -> Qos:
    """The profile of a publisher; the numbers of all policies are those of rclpy."""
    return Qos(
        QosHistory(int(offered.history)),
        offered.depth,
        QosReliability(int(offered.reliability)),
        QosDurability(int(offered.durability)),
        _time(offered.deadline),
        _time(offered.lifespan),
        QosLiveliness(int(offered.liveliness)),
        _time(offered.liveliness_lease_duration),
        offered.avoid_ros_namespace_conventions,
    )


def of_recording(offered: Sequence[QoSProfile]) -> QoSProfile:
    """The profile of a subscription for messages of all these publishers: reliable and retained only if all are."""
    is_reliable = all(one.reliability != ReliabilityPolicy.BEST_EFFORT for one in offered)
    is_retained = bool(offered) and all(one.durability == DurabilityPolicy.TRANSIENT_LOCAL for one in offered)
    return _profile(_DEPTH, is_reliable=is_reliable, is_retained=is_retained)


def of_playback(offered: Sequence[Qos]) -> QoSProfile:
    """The profile of a publisher in place of recorded ones: best-effort and retained only if all were."""
    is_reliable = not offered or any(one.reliability is not QosReliability.BEST_EFFORT for one in offered)
    is_retained = bool(offered) and all(one.durability is QosDurability.TRANSIENT_LOCAL for one in offered)
    depth = max((one.depth for one in offered), default=0)
    return _profile(depth or _UNKNOWN_DEPTH, is_reliable=is_reliable, is_retained=is_retained)


def _profile(depth: int, *, is_reliable: bool, is_retained: bool) -> QoSProfile:
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=depth,
        reliability=ReliabilityPolicy.RELIABLE if is_reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if is_retained else DurabilityPolicy.VOLATILE,
    )


def _time(duration: Duration) -> QosTime:
    return QosTime(*divmod(duration.nanoseconds, _SECOND_NS))
