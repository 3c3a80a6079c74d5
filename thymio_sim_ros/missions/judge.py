"""Judges a run by a mission: a pure observer of an engine, which changes nothing but what the mission itself does."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Any

from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.missions.conditions import Condition, Facts, names_in, read_condition
from thymio_sim_ros.missions.facts import Measured, Scene, Watch
from thymio_sim_ros.missions.free_zones import check_zones
from thymio_sim_ros.missions.lengths import length_of
from thymio_sim_ros.missions.mission import Happening, Mission, Star
from thymio_sim_ros.sim.commands import MoveObject
from thymio_sim_ros.sim.model.fields import FieldError, join, nearest
from thymio_sim_ros.sim.model.geometry import Point
from thymio_sim_ros.sim.playground.placement import PlacementError

__all__ = ["Item", "Judge", "State", "Verdict"]

TRACE_TICKS = 10
"""Ticks between two places of the trace."""
_SECOND_NS = 1_000_000_000


class State(Enum):
    """State of a mission."""

    RUNNING = "running"
    PASSED = "passed"
    FAILED = "failed"


@dataclass(frozen=True, slots=True)
class Item:
    """A line of the checklist: the facts that it needs, and whether it is done."""

    facts: tuple[str, ...]
    is_done: bool


@dataclass(frozen=True, slots=True)
class Verdict:
    """What a mission says of a run until `at_s`, simulated seconds.

    `stars` has one entry for the goal and one for each further star. `broken`: the facts for which it has failed; empty
    while it has not, or if its time is over.
    """

    state: State
    at_s: float
    checklist: tuple[Item, ...]
    stars: tuple[bool, ...]
    broken: tuple[str, ...] = ()

    @property
    def is_passed(self) -> bool:
        """Whether it is passed."""
        return self.state is State.PASSED

    @property
    def is_late(self) -> bool:
        """Whether it has failed because its time is over."""
        return self.state is State.FAILED and not self.broken


class _Checklist:
    """The parts of the condition for success: all of them in any order, or one after the other."""

    def __init__(self, data: object, facts: Sequence[str]) -> None:
        word = next((word for word in ("all", "then") if isinstance(data, Mapping) and word in data), "")
        parts = data[word] if word and isinstance(data, Mapping) else [data]
        self._is_ordered = word == "then"
        self._parts = [read_condition(part, f"success[{index}]", facts) for index, part in enumerate(parts)]
        self._facts = [tuple(dict.fromkeys(names_in(part))) for part in parts]
        self._are_done = [False] * len(parts)

    def update(self, facts: Facts, now_s: float) -> bool:
        """Take the facts of a tick; return whether all parts are done."""
        for index, part in enumerate(self._parts):
            if self._is_ordered and self._are_done[index]:
                continue
            self._are_done[index] = part.update(facts, now_s)
            if self._is_ordered and not self._are_done[index]:
                break
        return all(self._are_done)

    @property
    def done(self) -> tuple[bool, ...]:
        """Whether each part is done."""
        return tuple(self._are_done)

    def open_facts(self) -> tuple[str, ...]:
        """The facts of the parts that are not done; of the next part, if there is an order."""
        parts = [facts for facts, is_done in zip(self._facts, self._are_done, strict=True) if not is_done]
        return tuple(dict.fromkeys(itertools.chain(*(parts[:1] if self._is_ordered else parts))))

    def items(self) -> tuple[Item, ...]:
        """The lines of the checklist."""
        return tuple(Item(facts, is_done) for facts, is_done in zip(self._facts, self._are_done, strict=True))


class Judge:
    """Judges the run of an engine from now on, until the mission is passed or has failed.

    `tick` has to be called after each step of the engine.
    """

    def __init__(self, mission: Mission, engine: Engine) -> None:
        """Raises FieldError for a name that the playground does not have."""
        self._mission, self._engine = mission, engine
        self.robot = mission.robot or next(iter(engine.world.robots), "")
        """The robot that the pupil programs."""
        self._begin_ns = engine.now_ns
        self._tracks: dict[tuple[str, str], Any] = {}
        self._watches: dict[str, Watch] = {name: self._watch(name) for name in mission.facts}
        self._checks = [(name, watch.is_true) for name, watch in self._watches.items()]
        facts = list(mission.facts)
        check_zones(mission.zones, engine.world.playground)
        self._facts: Facts = dict.fromkeys(facts, False)
        self._checklist = _Checklist(mission.success, facts)
        self._failure = None if mission.failure is None else read_condition(mission.failure, "failure", facts)
        self._extras: list[Condition | None] = [
            None if star.when is None else read_condition(star.when, "when", facts) for star in mission.stars
        ]
        self._happens = list(mission.happens)
        for index, happening in enumerate(self._happens):
            self._check_target(happening, f"happens[{index}]")
        self._now_s = 0.0
        self._last: Verdict | None = None
        """The verdict of an end."""
        self.trace: list[Point] = []
        """Where the robot was, in m, every `TRACE_TICKS` ticks."""
        self._act(0.0)

    @property
    def verdict(self) -> Verdict:
        """What it says now."""
        if self._last is not None:
            return self._last
        return Verdict(State.RUNNING, self._now_s, self._checklist.items(), (False,) * (1 + len(self._mission.stars)))

    @property
    def is_over(self) -> bool:
        """Whether the mission has been passed or has failed."""
        return self._last is not None

    @property
    def done(self) -> tuple[bool, ...]:
        """Whether each line of the checklist is done."""
        return self._checklist.done

    def tick(self) -> None:
        """Judge the tick that the engine has executed; does nothing when the mission is over."""
        if self._last is not None:
            return
        now_ns = self._engine.now_ns - self._begin_ns
        now_s = now_ns / _SECOND_NS
        facts = self._facts = {name: is_true() for name, is_true in self._checks}
        self._note_place()
        extras = [extra is not None and extra.update(facts, now_s) for extra in self._extras]
        is_done = self._checklist.update(facts, now_s)
        is_broken = self._failure is not None and self._failure.update(facts, now_s)
        if is_broken:
            named = tuple(dict.fromkeys(names_in(self._mission.failure)))
            self._end(State.FAILED, now_s, [], tuple(name for name in named if facts[name]) or named)
        elif is_done:
            self._end(State.PASSED, now_s, extras)
        elif now_s >= self._mission.time_s:
            self._end(State.FAILED, now_s, [])
        else:
            self._now_s = now_s
            self._act(now_s)

    def measured(self) -> dict[str, Measured]:
        """How far each fact is that is a quantity, by name."""
        found = {name: watch.measure() for name, watch in self._watches.items() if watch.measure is not None}
        return {name: value for name, value in found.items() if value is not None}

    def missing(self) -> tuple[str, ...]:
        """The facts that the checklist lacks now, in order; of an ordered one those of the part that is next."""
        named = self._checklist.open_facts()
        return tuple(name for name in named if not self._facts[name]) or named

    def _end(self, state: State, now_s: float, extras: Sequence[bool], broken: tuple[str, ...] = ()) -> None:
        further = [
            self._has_star(star, now_s, extra) for star, extra in zip(self._mission.stars, extras, strict=False)
        ] or [False] * len(self._mission.stars)
        stars = (state is State.PASSED, *further)
        self._last = Verdict(state, now_s, self._checklist.items(), stars, broken)

    def _has_star(self, star: Star, now_s: float, extra: bool) -> bool:
        if star.within_s is not None:
            return now_s <= star.within_s
        if star.length is not None:
            host = self._engine.hosts.get(self.robot)
            return host is not None and length_of(host.program)[0] <= star.length
        return extra

    def _watch(self, name: str) -> Watch:
        found = self._mission.facts[name]
        key = f"facts.{name}"
        robot = self._check_robot(found.robot, join(key, "robot"))
        try:
            return found.fact.watch(Scene(self._engine, self._mission.zones, robot, self._tracks))
        except FieldError as error:
            raise FieldError(join(key, error.key), error.found, error.expected) from error

    def _check_robot(self, robot: str, key: str) -> str:
        """The robot of a name, "" is that of the mission. Raises FieldError if there is none."""
        name = robot or self.robot
        if name not in self._engine.world.robots:
            raise FieldError(key, f"'{name}'", nearest(name, tuple(self._engine.world.robots)))
        return name

    def _check_target(self, happening: Happening, key: str) -> None:
        if not isinstance(happening.command, MoveObject):
            self._check_robot(happening.robot, join(key, "robot"))
            return
        names = [solid.name for solid in self._engine.world.playground.solids if solid.load is not None]
        if happening.robot not in names:
            raise FieldError(
                join(key, "move"), f"'{happening.robot}'", f"a movable object: {nearest(happening.robot, names)}"
            )

    def _act(self, now_s: float) -> None:
        """Do what happens until now; it has its effect in the next tick. A place that is occupied is waited for."""
        while self._happens and self._happens[0].at_s <= now_s:
            happening = self._happens[0]
            try:
                self._engine.post(happening.robot or self.robot, happening.command)
            except PlacementError:
                return
            self._happens.pop(0)

    def _note_place(self) -> None:
        if self._engine.tick % TRACE_TICKS:
            return
        robot = self._engine.world.robots.get(self.robot)
        if robot is not None:
            self.trace.append((robot.pose.x_m, robot.pose.y_m))
