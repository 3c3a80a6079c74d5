"""A sweep as data: what varies, what is measured, and the runs in their canonical order."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import math
from dataclasses import dataclass

from thymio_sim_ros import __version__

__all__ = ["Run", "Source", "Sweep", "Value"]

Value = bool | int | float | str
"""A value of a parameter."""


@dataclass(frozen=True, slots=True)
class Source:
    """A program or playground: its name in the table, and its whole text, which needs no other file."""

    name: str
    text: str


@dataclass(frozen=True, slots=True)
class Run:
    """One run: its number in the sweep, and what it runs."""

    number: int
    program: Source
    playground: Source
    values: tuple[tuple[str, Value], ...]
    """The parameters by name."""
    seed: int


@dataclass(frozen=True, slots=True)
class Sweep:
    """Parameters and measures of a sweep, with all texts, so that any machine can execute any of its runs."""

    programs: tuple[Source, ...]
    playgrounds: tuple[Source, ...]
    parameters: tuple[tuple[str, tuple[Value, ...]], ...]
    """Names of parameters, each with its values."""
    seeds: tuple[int, ...]
    seconds: float
    """Simulated time of a run."""
    measures: tuple[str, ...]
    limit_s: float
    """Processor time after which a run is given up, in s."""

    @property
    def fingerprint(self) -> str:
        """Twelve digits that differ for sweeps that could have other results."""
        content = json.dumps([__version__, dataclasses.asdict(self)], sort_keys=True)
        return hashlib.sha256(content.encode()).hexdigest()[:12]

    def __len__(self) -> int:
        """Number of runs."""
        combinations = math.prod(len(values) for _, values in self.parameters)
        return len(self.programs) * len(self.playgrounds) * combinations * len(self.seeds)

    def run(self, number: int) -> Run:
        """A run by its number, 0 … len - 1: the seed varies fastest, then the last parameter."""
        rest, seed = divmod(number, len(self.seeds))
        values: list[tuple[str, Value]] = []
        for name, candidates in reversed(self.parameters):
            rest, index = divmod(rest, len(candidates))
            values.insert(0, (name, candidates[index]))
        program, playground = divmod(rest, len(self.playgrounds))
        return Run(number, self.programs[program], self.playgrounds[playground], tuple(values), self.seeds[seed])
