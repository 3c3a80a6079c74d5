"""A tree of frames over time, without nodes and messages: transforms are stored, interpolated and composed.

The rules are those of tf2: a frame has one parent at a time; between two transforms to the same parent, translations
are interpolated linearly and rotations along the shortest arc (slerp); before the first and after the last transform
there is no extrapolation; time 0 means the latest time at which all transforms between two frames are known. Times are
integer nanoseconds.
"""

from __future__ import annotations

import bisect
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from operator import attrgetter
from typing import TypeAlias

from thymio_sim_ros.tf.errors import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TransformException,
)

__all__ = ["CACHE_NS", "IDENTITY", "LATEST_NS", "BufferCore", "OldDataError", "RigidTransform", "StampedTransform"]

Vector: TypeAlias = tuple[float, float, float]
Quaternion: TypeAlias = tuple[float, float, float, float]

CACHE_NS = 10_000_000_000
"""Default time for which transforms are kept, counted back from the latest one of a frame, as in tf2."""
LATEST_NS = 0
"""Time that stands for the latest common time."""
NORM_TOLERANCE = 1e-2
"""Largest deviation of the squared norm of a quaternion from 1."""
_DEPTH = 1000
"""Largest depth of the tree; a longer chain of parents is a loop."""


class OldDataError(TransformException):
    """A transform is too old to be kept, or is a second one for the same time."""


@dataclass(frozen=True, slots=True)
class RigidTransform:
    """A rotation by a unit quaternion x, y, z, w, followed by a translation in m."""

    translation: Vector = (0.0, 0.0, 0.0)
    rotation: Quaternion = (0.0, 0.0, 0.0, 1.0)

    def __mul__(self, other: RigidTransform) -> RigidTransform:
        """The composition: `other` is applied first."""
        x, y, z = self.rotate(other.translation)
        dx, dy, dz = self.translation
        return RigidTransform((x + dx, y + dy, z + dz), quaternion_product(self.rotation, other.rotation))

    def inverse(self) -> RigidTransform:
        """The inverse transform."""
        x, y, z, w = self.rotation
        back = RigidTransform(rotation=(-x, -y, -z, w))
        dx, dy, dz = back.rotate(self.translation)
        return RigidTransform((-dx, -dy, -dz), back.rotation)

    def rotate(self, vector: Vector) -> Vector:
        """Rotate a vector, without translation: v + 2 w (q × v) + 2 q × (q × v), where q is the vector part."""
        qx, qy, qz, qw = self.rotation
        x, y, z = vector
        tx, ty, tz = 2 * (qy * z - qz * y), 2 * (qz * x - qx * z), 2 * (qx * y - qy * x)
        return (
            x + qw * tx + qy * tz - qz * ty,
            y + qw * ty + qz * tx - qx * tz,
            z + qw * tz + qx * ty - qy * tx,
        )

    def apply(self, point: Vector) -> Vector:
        """Rotate and translate a point."""
        x, y, z = self.rotate(point)
        dx, dy, dz = self.translation
        return (x + dx, y + dy, z + dz)

    def interpolate(self, other: RigidTransform, part: float) -> RigidTransform:
        """Interpolate to another transform by a fraction `part` in 0…1."""
        (x, y, z), (u, v, w) = self.translation, other.translation
        translation = (x + part * (u - x), y + part * (v - y), z + part * (w - z))
        return RigidTransform(translation, slerp(self.rotation, other.rotation, part))


IDENTITY = RigidTransform()


@dataclass(frozen=True, slots=True)
class StampedTransform:
    """The pose of `child` in `frame` at a time; `motion` converts coordinates in `child` to those in `frame`."""

    stamp_ns: int
    frame: str
    child: str
    motion: RigidTransform


@dataclass(slots=True)
class _Cache:
    """The transforms of one frame, oldest first, or its single static transform."""

    is_static: bool
    authority: str
    kept: list[StampedTransform] = field(default_factory=list)


class BufferCore:
    """The transforms of all frames; those of the last `cache_ns` of each frame."""

    def __init__(self, cache_ns: int = CACHE_NS) -> None:
        self._cache_ns = cache_ns
        self._caches: dict[str, _Cache] = {}
        self._frames: dict[str, None] = {}

    def set_transform(self, placed: StampedTransform, authority: str = "unknown", *, is_static: bool = False) -> None:
        """Store a transform. Raises InvalidArgumentException if invalid, OldDataError if too old or repeated."""
        placed = _checked(placed)
        self._frames |= {placed.frame: None, placed.child: None}
        cache = self._caches.get(placed.child)
        if cache is None or cache.is_static != is_static:
            cache = self._caches[placed.child] = _Cache(is_static, authority)
        cache.authority = authority
        if is_static:
            cache.kept = [placed]
            return
        kept = cache.kept
        at = bisect.bisect_left(kept, placed.stamp_ns, key=_STAMP)
        if kept and kept[-1].stamp_ns > placed.stamp_ns + self._cache_ns:
            raise OldDataError(
                f"the transform of {placed.child} at time {_s(placed.stamp_ns)} is too old: the latest one is at"
                f" {_s(kept[-1].stamp_ns)}, and only {self._cache_ns / 1e9:g} s are kept"
            )
        if at < len(kept) and kept[at].stamp_ns == placed.stamp_ns:
            raise OldDataError(f"a transform of {placed.child} at time {_s(placed.stamp_ns)} exists already")
        kept.insert(at, placed)
        del kept[: bisect.bisect_left(kept, kept[-1].stamp_ns - self._cache_ns, key=_STAMP)]

    def clear(self) -> None:
        """Drop all transforms except static ones."""
        for cache in self._caches.values():
            if not cache.is_static:
                cache.kept.clear()

    def lookup(self, target: str, source: str, time_ns: int = LATEST_NS) -> StampedTransform:
        """The pose of `source` in `target`, which converts coordinates in `source` to coordinates in `target`.

        Both frames are followed to their ancestors at that time; the result is composed at the first common ancestor.
        Raises InvalidArgumentException, LookupException, ConnectivityException or ExtrapolationException.
        """
        for role, name in (("target_frame", target), ("source_frame", source)):
            self._check_known(name, role)
        if target == source:
            latest = self._latest_ns(source) if time_ns == LATEST_NS else time_ns
            return StampedTransform(latest, target, source, IDENTITY)
        if time_ns == LATEST_NS:
            time_ns = self._latest_common_ns(target, source)
        up, source_error = self._chain(source, time_ns)
        down, target_error = self._chain(target, time_ns)
        common = next((name for name in up if name in down), None)
        if common is None:
            way = f"when looking up transform from frame [{source}] to frame [{target}]"
            for found in (source_error, target_error):
                if found:
                    raise ExtrapolationException(f"{found}, {way}")
            raise self._unconnected(target, source)
        return StampedTransform(time_ns, target, source, down[common].inverse() * up[common])

    def lookup_full(self, target: str, target_ns: int, source: str, source_ns: int, fixed: str) -> StampedTransform:
        """The pose of `source` at one time in `target` at another time; `fixed` does not move in between.

        Raises the exceptions of `lookup`.
        """
        self._check_known(fixed, "fixed_frame")
        first, second = self.lookup(fixed, source, source_ns), self.lookup(target, fixed, target_ns)
        return StampedTransform(second.stamp_ns, target, source, second.motion * first.motion)

    def velocity(
        self,
        tracking: str,
        observation: str,
        reference: str,
        point: Vector,
        point_frame: str,
        time_ns: int,
        averaging_ns: int,
    ) -> tuple[Vector, Vector]:
        """The linear and angular velocity of `tracking` seen from `observation`, in m/s and rad/s, along `reference`.

        It is the mean of the time `averaging_ns` around `time_ns`, or before the latest common time if that is earlier.
        The linear velocity is that of the `point` of `point_frame`, as if it were fixed to `tracking`.
        Raises the exceptions of `lookup`.
        """
        latest_ns = self.latest_common_ns(observation, tracking)
        end_ns = latest_ns if time_ns == LATEST_NS else min(time_ns + averaging_ns // 2, latest_ns)
        start_ns = max(end_ns - averaging_ns, LATEST_NS + 1)
        if end_ns <= start_ns:
            raise ExtrapolationException(
                f"the velocity of [{tracking}] in [{observation}] needs transforms of two times, but the latest is at"
                f" {_s(latest_ns)}"
            )
        duration_s = (end_ns - start_ns) / 1e9
        start = self.lookup(observation, tracking, start_ns).motion
        end = self.lookup(observation, tracking, end_ns).motion
        linear = _scaled(_difference(end.translation, start.translation), 1.0 / duration_s)
        angular = _scaled(_rotation_vector(RigidTransform(rotation=end.rotation) * start.inverse()), 1.0 / duration_s)
        lever = _difference(self.lookup(observation, point_frame, end_ns).motion.apply(point), end.translation)
        turning = _cross(angular, lever)
        linear = (linear[0] + turning[0], linear[1] + turning[1], linear[2] + turning[2])
        seen = self.lookup(reference, observation, end_ns).motion
        return seen.rotate(linear), seen.rotate(angular)

    def latest_common_ns(self, target: str, source: str) -> int:
        """The latest time at which all transforms between two frames are known; 0 if all are static.

        Raises InvalidArgumentException, LookupException or ConnectivityException.
        """
        for role, name in (("target_frame", target), ("source_frame", source)):
            self._check_known(name, role)
        return self._latest_ns(source) if target == source else self._latest_common_ns(target, source)

    def frames(self) -> tuple[str, ...]:
        """All frames, in order of appearance."""
        return tuple(self._frames)

    def parent_of(self, frame: str) -> str | None:
        """The latest parent of a frame, None if it has none."""
        cache = self._caches.get(frame)
        return cache.kept[-1].frame if cache is not None and cache.kept else None

    def as_text(self) -> str:
        """One line for each frame with a parent, in the format of tf2."""
        return "".join(
            f"Frame {name} exists with parent {self.parent_of(name)}.\n"
            for name in self._frames
            if self.parent_of(name) is not None
        )

    def as_yaml(self) -> str:
        """Parent, broadcaster, rate and stored times of each frame, in the format of tf2's view_frames."""
        parts = []
        for name, cache in self._caches.items():
            if cache.kept:
                first, last = cache.kept[0].stamp_ns, cache.kept[-1].stamp_ns
                seconds = (last - first) / 1e9
                rate = 10_000.0 if cache.is_static else len(cache.kept) / max(seconds, 1e-4)
                parts.append(
                    f"{name}: \n  parent: '{cache.kept[-1].frame}'\n  broadcaster: '{cache.authority}'\n"
                    f"  rate: {rate:.3f}\n  most_recent_transform: {_s(last)}\n  oldest_transform: {_s(first)}\n"
                    f"  buffer_length: {seconds:.3f}\n"
                )
        return "".join(parts) or "[]"

    def _check_known(self, name: str, role: str) -> None:
        _check_name(name, role)
        if name not in self._frames:
            known = ", ".join(sorted(self._frames)) or "none"
            raise LookupException(
                f'"{name}" passed to lookupTransform argument {role} does not exist; known frames: {known}'
            )

    def _unconnected(self, target: str, source: str) -> ConnectivityException:
        return ConnectivityException(
            f"Could not find a connection between '{target}' and '{source}' because they are not part of the same tree:"
            " tf has two or more unconnected trees."
        )

    def _parents(self, frame: str) -> Iterator[tuple[str, _Cache]]:
        """A frame and its latest ancestors without the root, with their caches. Raises LookupException for a loop."""
        for _ in range(_DEPTH):
            cache = self._caches.get(frame)
            if cache is None or not cache.kept:
                return
            yield frame, cache
            frame = cache.kept[-1].frame
        raise LookupException(f"the frames have a loop at '{frame}'")

    def _latest_ns(self, frame: str) -> int:
        return next((cache.kept[-1].stamp_ns for _, cache in self._parents(frame) if not cache.is_static), LATEST_NS)

    def _latest_common_ns(self, target: str, source: str) -> int:
        """The earliest of the latest times of all transforms between two frames; 0 if all are static."""
        ways = [list(self._parents(target)), list(self._parents(source))]
        above = [[name for name, _ in way] + [way[-1][1].kept[-1].frame] if way else [] for way in ways]
        names = [above[0] or [target], above[1] or [source]]
        common = next((name for name in names[1] if name in names[0]), None)
        if common is None:
            raise self._unconnected(target, source)
        between = [way[: names[side].index(common)] for side, way in enumerate(ways)]
        stamps = [cache.kept[-1].stamp_ns for way in between for _, cache in way if not cache.is_static]
        return min(stamps, default=LATEST_NS)

    def _chain(self, frame: str, time_ns: int) -> tuple[dict[str, RigidTransform], str]:
        """The ancestors of a frame at a time, with the transforms that convert its coordinates to theirs.

        Also returns the reason if the chain ends because of a missing transform, otherwise an empty string.
        """
        motion, found = IDENTITY, {frame: IDENTITY}
        for _ in range(_DEPTH):
            cache = self._caches.get(frame)
            if cache is None:
                return found, ""
            placed, error = _transform_at(cache, time_ns)
            if placed is None:
                return found, error
            frame, motion = placed.frame, placed.motion * motion
            found[frame] = motion
        raise LookupException(f"the frames have a loop at '{frame}'")


_STAMP = attrgetter("stamp_ns")


def _transform_at(cache: _Cache, time_ns: int) -> tuple[StampedTransform | None, str]:
    """The transform of a frame at a time, interpolated; None and the reason if there is none."""
    kept: Sequence[StampedTransform] = cache.kept
    if not kept:
        return None, "Lookup would require extrapolation: no transform has been received since the buffer was cleared"
    if cache.is_static or time_ns == LATEST_NS:
        return kept[-1], ""
    first, last = kept[0].stamp_ns, kept[-1].stamp_ns
    if not first <= time_ns <= last:
        wanted = f"Requested time {_s(time_ns)} but the"
        if first == last:
            return None, (
                f"Lookup would require extrapolation at time {_s(time_ns)}, but only time {_s(last)} is in the buffer"
            )
        if time_ns > last:
            return None, (
                f"Lookup would require extrapolation into the future. {wanted} latest data is at time {_s(last)}"
            )
        return None, f"Lookup would require extrapolation into the past. {wanted} earliest data is at time {_s(first)}"
    after = bisect.bisect_left(kept, time_ns, key=_STAMP)
    later = kept[after]
    if later.stamp_ns == time_ns:
        return later, ""
    earlier = kept[after - 1]
    if earlier.frame != later.frame:  # another parent: transforms to different parents cannot be interpolated
        return earlier, ""
    part = (time_ns - earlier.stamp_ns) / (later.stamp_ns - earlier.stamp_ns)
    return replace(earlier, stamp_ns=time_ns, motion=earlier.motion.interpolate(later.motion, part)), ""


def _checked(placed: StampedTransform) -> StampedTransform:
    """Remove leading slashes of the frame names. Raises InvalidArgumentException for an invalid transform."""
    frame, child = placed.frame.removeprefix("/"), placed.child.removeprefix("/")
    for role, name in (("frame_id", frame), ("child_frame_id", child)):
        if not name:
            raise InvalidArgumentException(f"the transform of '{child}' in '{frame}' has an empty {role}")
    if frame == child:
        raise InvalidArgumentException(f"the transform of '{child}' has the same frame as frame_id")
    numbers = (*placed.motion.translation, *placed.motion.rotation)
    if not all(map(math.isfinite, numbers)):
        raise InvalidArgumentException(f"the transform of '{child}' in '{frame}' has a value that is NaN or infinite")
    squared = sum(part * part for part in placed.motion.rotation)
    if abs(squared - 1.0) > NORM_TOLERANCE:
        raise InvalidArgumentException(
            f"the transform of '{child}' in '{frame}' has a quaternion of norm {math.sqrt(squared):.3g}, expected 1"
        )
    return replace(placed, frame=frame, child=child)


def _check_name(name: str, role: str) -> None:
    if not isinstance(name, str):
        raise TypeError(f"{role}: found {name!r}, expected a str")
    passed = f"passed to lookupTransform argument {role} in tf2 frame_ids cannot"
    if not name:
        raise InvalidArgumentException(f"Invalid argument {passed} be empty")
    if name.startswith("/"):
        raise InvalidArgumentException(f"Invalid argument \"{name}\" {passed} start with a '/'")


def _difference(one: Vector, other: Vector) -> Vector:
    return (one[0] - other[0], one[1] - other[1], one[2] - other[2])


def _scaled(vector: Vector, factor: float) -> Vector:
    return (vector[0] * factor, vector[1] * factor, vector[2] * factor)


def _cross(one: Vector, other: Vector) -> Vector:
    (x, y, z), (a, b, c) = one, other
    return (y * c - z * b, z * a - x * c, x * b - y * a)


def _rotation_vector(turned: RigidTransform) -> Vector:
    """The axis of a rotation, times its angle of at most π rad."""
    x, y, z, w = turned.rotation
    sine = math.hypot(x, y, z)
    if sine == 0.0:
        return (0.0, 0.0, 0.0)
    angle = 2.0 * math.atan2(sine, abs(w)) * math.copysign(1.0, w)
    return _scaled((x, y, z), angle / sine)


def quaternion_product(one: Quaternion, other: Quaternion) -> Quaternion:
    """The product of two quaternions x, y, z, w: the rotation `other` is applied first."""
    x, y, z, w = one
    a, b, c, d = other
    return (
        w * a + x * d + y * c - z * b,
        w * b - x * c + y * d + z * a,
        w * c + x * b - y * a + z * d,
        w * d - x * a - y * b - z * c,
    )


def slerp(one: Quaternion, other: Quaternion, part: float) -> Quaternion:
    """Interpolate between two unit quaternions along the shortest arc, by a fraction `part` in 0…1.

    q and -q are the same rotation: with a negative cosine the second one is negated. For very small angles, linear
    interpolation avoids the division by a sine near 0. The result is normalized.
    """
    cosine = sum(p * q for p, q in zip(one, other, strict=True))
    sign = -1.0 if cosine < 0.0 else 1.0
    angle = math.acos(min(1.0, abs(cosine)))
    if angle < 1e-7:
        start, end = 1.0 - part, part * sign
    else:
        start, end = math.sin((1.0 - part) * angle) / math.sin(angle), sign * math.sin(part * angle) / math.sin(angle)
    mixed = [start * p + end * q for p, q in zip(one, other, strict=True)]
    length = math.sqrt(sum(p * p for p in mixed))
    x, y, z, w = (p / length for p in mixed)
    return (x, y, z, w)


def _s(stamp_ns: int) -> str:
    return f"{stamp_ns / 1e9:.6f}"
