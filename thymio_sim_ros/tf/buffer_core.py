"""A tree of frames over time: kept, interpolated, composed. It knows no node and no message.

Its rules are those of tf2: a frame has one parent at a time; between two transforms of the same parent translations are
interpolated linearly and rotations on the shortest great circle; beyond the first and the last nothing is guessed; time
0 stands for the latest time at which all transforms on the way are known. Times are integer nanoseconds.
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
"""How long transforms are kept, counted back from a frame's latest one, as tf2 does."""
LATEST_NS = 0
NORM_TOLERANCE = 1e-2
"""How far the squared length of a quaternion may be from 1."""
_DEPTH = 1000
"""Frames on the way to a root; more are a loop."""


class OldDataError(TransformException):
    """A transform that is older than all that is kept, or a second one for the same time."""


@dataclass(frozen=True, slots=True)
class RigidTransform:
    """A rotation, then a translation: a unit quaternion x, y, z, w, and m."""

    translation: Vector = (0.0, 0.0, 0.0)
    rotation: Quaternion = (0.0, 0.0, 0.0, 1.0)

    def __mul__(self, other: RigidTransform) -> RigidTransform:
        """What `other` does, and then this."""
        x, y, z = self.rotate(other.translation)
        dx, dy, dz = self.translation
        return RigidTransform((x + dx, y + dy, z + dz), quaternion_product(self.rotation, other.rotation))

    def inverse(self) -> RigidTransform:
        """The way back."""
        x, y, z, w = self.rotation
        back = RigidTransform(rotation=(-x, -y, -z, w))
        dx, dy, dz = back.rotate(self.translation)
        return RigidTransform((-dx, -dy, -dz), back.rotation)

    def rotate(self, vector: Vector) -> Vector:
        """A vector after the rotation alone."""
        qx, qy, qz, qw = self.rotation
        x, y, z = vector
        tx, ty, tz = 2 * (qy * z - qz * y), 2 * (qz * x - qx * z), 2 * (qx * y - qy * x)
        return (
            x + qw * tx + qy * tz - qz * ty,
            y + qw * ty + qz * tx - qx * tz,
            z + qw * tz + qx * ty - qy * tx,
        )

    def moved(self, point: Vector) -> Vector:
        """A point after both."""
        x, y, z = self.rotate(point)
        dx, dy, dz = self.translation
        return (x + dx, y + dy, z + dz)

    def interpolate(self, other: RigidTransform, part: float) -> RigidTransform:
        """A part 0…1 of the way to another."""
        (x, y, z), (u, v, w) = self.translation, other.translation
        place = (x + part * (u - x), y + part * (v - y), z + part * (w - z))
        return RigidTransform(place, slerp(self.rotation, other.rotation, part))


IDENTITY = RigidTransform()


@dataclass(frozen=True, slots=True)
class StampedTransform:
    """A frame `child` in another, at a time; `motion` takes coordinates of the child to those of `frame`."""

    stamp_ns: int
    frame: str
    child: str
    motion: RigidTransform


@dataclass(slots=True)
class _Cache:
    """All that is known of one frame: by time, the oldest first; or one that holds always."""

    is_static: bool
    authority: str
    kept: list[StampedTransform] = field(default_factory=list)


class BufferCore:
    """Transforms of the last `cache_ns` of each frame."""

    def __init__(self, cache_ns: int = CACHE_NS) -> None:
        self._cache_ns = cache_ns
        self._caches: dict[str, _Cache] = {}
        self._frames: dict[str, None] = {}

    def set_transform(self, placed: StampedTransform, authority: str = "unknown", *, is_static: bool = False) -> None:
        """Keep a transform. InvalidArgumentException for one that cannot be, OldDataError for one that is too old."""
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
                f"the transform of {placed.child} at time {_s(placed.stamp_ns)} is left out: the latest one is at"
                f" {_s(kept[-1].stamp_ns)}, and only {self._cache_ns / 1e9:g} s are kept"
            )
        if at < len(kept) and kept[at].stamp_ns == placed.stamp_ns:
            raise OldDataError(f"a second transform of {placed.child} at time {_s(placed.stamp_ns)} is left out")
        kept.insert(at, placed)
        del kept[: bisect.bisect_left(kept, kept[-1].stamp_ns - self._cache_ns, key=_STAMP)]

    def clear(self) -> None:
        """Forget all that changes; what is static stays."""
        for cache in self._caches.values():
            if not cache.is_static:
                cache.kept.clear()

    def lookup(self, target: str, source: str, time_ns: int = LATEST_NS) -> StampedTransform:
        """Where `source` is in `target`: takes coordinates of source to target.

        InvalidArgumentException, LookupException, ConnectivityException, ExtrapolationException.
        """
        for role, name in (("target_frame", target), ("source_frame", source)):
            self._check_known(name, role)
        if target == source:
            latest = self._latest_ns(source) if time_ns == LATEST_NS else time_ns
            return StampedTransform(latest, target, source, IDENTITY)
        if time_ns == LATEST_NS:
            time_ns = self._latest_common_ns(target, source)
        up, its_error = self._chain(source, time_ns)
        down, error = self._chain(target, time_ns)
        meeting = next((name for name in up if name in down), None)
        if meeting is None:
            way = f"when looking up transform from frame [{source}] to frame [{target}]"
            for found in (its_error, error):
                if found:
                    raise ExtrapolationException(f"{found}, {way}")
            raise self._unconnected(target, source)
        return StampedTransform(time_ns, target, source, down[meeting].inverse() * up[meeting])

    def lookup_full(self, target: str, target_ns: int, source: str, source_ns: int, fixed: str) -> StampedTransform:
        """Where `source` was at a time in `target` at another time; `fixed` does not move in between."""
        self._check_known(fixed, "fixed_frame")
        first, second = self.lookup(fixed, source, source_ns), self.lookup(target, fixed, target_ns)
        return StampedTransform(second.stamp_ns, target, source, second.motion * first.motion)

    def frames(self) -> tuple[str, ...]:
        """Every frame that was named, in order of appearance."""
        return tuple(self._frames)

    def parent_of(self, frame: str) -> str | None:
        """The parent that a frame has now."""
        cache = self._caches.get(frame)
        return cache.kept[-1].frame if cache is not None and cache.kept else None

    def as_text(self) -> str:
        """A line for each frame with a parent, as tf2 writes it."""
        return "".join(
            f"Frame {name} exists with parent {self.parent_of(name)}.\n"
            for name in self._frames
            if self.parent_of(name) is not None
        )

    def as_yaml(self) -> str:
        """What tf2's view_frames draws: for each frame its parent, who sends it, how often and how much is kept."""
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
        _check_name(name, f"passed as {role}")
        if name not in self._frames:
            known = ", ".join(sorted(self._frames)) or "none"
            raise LookupException(f'"{name}" passed as {role} does not exist; frames there are: {known}')

    def _unconnected(self, target: str, source: str) -> ConnectivityException:
        return ConnectivityException(
            f"Could not find a connection between '{target}' and '{source}' because they are not part of the same tree:"
            " tf has two or more unconnected trees."
        )

    def _parents(self, frame: str) -> Iterator[tuple[str, _Cache]]:
        """A frame and those above it as they are now, each with what is known of it."""
        for _ in range(_DEPTH):
            cache = self._caches.get(frame)
            if cache is None or not cache.kept:
                return
            yield frame, cache
            frame = cache.kept[-1].frame
        raise LookupException(f"the tree of frames has a loop at '{frame}'")

    def _latest_ns(self, frame: str) -> int:
        return next((cache.kept[-1].stamp_ns for _, cache in self._parents(frame) if not cache.is_static), LATEST_NS)

    def _latest_common_ns(self, target: str, source: str) -> int:
        """The earliest of the latest times on the way; 0 if all of it is static."""
        ways = [list(self._parents(target)), list(self._parents(source))]
        above = [[name for name, _ in way] + [way[-1][1].kept[-1].frame] if way else [] for way in ways]
        names = [above[0] or [target], above[1] or [source]]
        meeting = next((name for name in names[1] if name in names[0]), None)
        if meeting is None:
            raise self._unconnected(target, source)
        on_the_way = [way[: names[side].index(meeting)] for side, way in enumerate(ways)]
        stamps = [cache.kept[-1].stamp_ns for way in on_the_way for _, cache in way if not cache.is_static]
        return min(stamps, default=LATEST_NS)

    def _chain(self, frame: str, time_ns: int) -> tuple[dict[str, RigidTransform], str]:
        """Every frame above one at a time, and what takes its coordinates there; why it ends early, or nothing."""
        motion, found = IDENTITY, {frame: IDENTITY}
        for _ in range(_DEPTH):
            cache = self._caches.get(frame)
            if cache is None:
                return found, ""
            placed, error = _at(cache, time_ns)
            if placed is None:
                return found, error
            frame, motion = placed.frame, placed.motion * motion
            found[frame] = motion
        raise LookupException(f"the tree of frames has a loop at '{frame}'")


_STAMP = attrgetter("stamp_ns")


def _at(cache: _Cache, time_ns: int) -> tuple[StampedTransform | None, str]:
    """What is known of a frame at a time, or why nothing is."""
    kept: Sequence[StampedTransform] = cache.kept
    if not kept:
        return None, "Lookup would require extrapolation: nothing is kept since time went back"
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
    if earlier.frame != later.frame:
        return earlier, ""
    part = (time_ns - earlier.stamp_ns) / (later.stamp_ns - earlier.stamp_ns)
    return replace(earlier, stamp_ns=time_ns, motion=earlier.motion.interpolate(later.motion, part)), ""


def _checked(placed: StampedTransform) -> StampedTransform:
    """The same without a slash before its names; InvalidArgumentException for one that is no transform."""
    frame, child = placed.frame.removeprefix("/"), placed.child.removeprefix("/")
    for role, name in (("frame_id", frame), ("child_frame_id", child)):
        if not name:
            raise InvalidArgumentException(f"a transform of '{child}' in '{frame}' has no {role}")
    if frame == child:
        raise InvalidArgumentException(f"a transform of '{child}' in itself")
    numbers = (*placed.motion.translation, *placed.motion.rotation)
    if not all(map(math.isfinite, numbers)):
        raise InvalidArgumentException(f"the transform of '{child}' in '{frame}' has a number that is not finite")
    squared = sum(part * part for part in placed.motion.rotation)
    if abs(squared - 1.0) > NORM_TOLERANCE:
        raise InvalidArgumentException(
            f"the transform of '{child}' in '{frame}' has a quaternion of length {math.sqrt(squared):.3g}, expected 1"
        )
    return replace(placed, frame=frame, child=child)


def _check_name(name: str, what: str) -> None:
    if not name:
        raise InvalidArgumentException(f"an empty name {what}: frame ids in tf2 cannot be empty")
    if name.startswith("/"):
        raise InvalidArgumentException(f"\"{name}\" {what}: frame ids in tf2 cannot start with a '/'")


def quaternion_product(one: Quaternion, other: Quaternion) -> Quaternion:
    """The rotation `other`, then `one`; x, y, z, w."""
    x, y, z, w = one
    a, b, c, d = other
    return (
        w * a + x * d + y * c - z * b,
        w * b - x * c + y * d + z * a,
        w * c + x * b - y * a + z * d,
        w * d - x * a - y * b - z * c,
    )


def slerp(one: Quaternion, other: Quaternion, part: float) -> Quaternion:
    """A part 0…1 of the shortest way between two unit quaternions."""
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
