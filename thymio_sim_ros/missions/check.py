"""Whether the programs that a mission names do what they are there for: a solution has all stars, a start none."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from thymio_sim_ros.missions.judge import Judge, Verdict
from thymio_sim_ros.missions.mission import Mission

__all__ = ["GROUPS", "ProgramRun", "is_node", "program_runs"]

GROUPS = ("solutions", "programs")
_NODE = ".py"


@dataclass(frozen=True, slots=True)
class ProgramRun:
    """A program of a mission after its run; without a verdict it was not run."""

    group: str
    """One of `GROUPS`."""
    language: str
    verdict: Verdict | None

    @property
    def key(self) -> str:
        """Its place in the file of the mission."""
        return f"{self.group}.{self.language}"

    @property
    def mistake(self) -> str:
        """What is wrong with it; "": nothing that is known."""
        if self.verdict is None:
            return ""
        if self.group == "solutions" and not all(self.verdict.stars):
            return f"found {sum(self.verdict.stars)} of {len(self.verdict.stars)} stars, expected all of them"
        if self.group == "programs" and self.verdict.is_passed:
            return "found a start that passes, expected something to do"
        return ""


def is_node(program: str) -> bool:
    """Whether a program is a ROS node, by the ending of its file."""
    return program.endswith(_NODE)


def program_runs(
    mission: Mission, judge: Callable[[str], Judge | None], groups: Sequence[str] = GROUPS
) -> Iterator[ProgramRun]:
    """Run the programs of these groups in order. `judge` runs the program of a path; None: it is not run."""
    named = {"solutions": mission.solutions, "programs": mission.programs}
    for group in groups:
        for language, program in named[group].items():
            judged = judge(program)
            yield ProgramRun(group, language, None if judged is None else judged.verdict)
