"""The values of a mission file. `reader.py` reads it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from thymio_sim_ros.missions.facts import Fact
from thymio_sim_ros.missions.zones import Zone
from thymio_sim_ros.sim.commands import Command

__all__ = ["PROGRAM_LANGUAGES", "Happening", "Mission", "MissionFact", "Star", "Texts", "Toolbox"]

PROGRAM_LANGUAGES = ("vpl", "blocks", "scratch", "text", "ros")
"""Languages in which pupils program."""


@dataclass(frozen=True, slots=True)
class MissionFact:
    """A named fact of a mission: of which robot ("" is that of the mission), and its text for pupils."""

    fact: Fact
    robot: str = ""
    text: str = ""
    missing: str = ""
    """Text for a pupil whose robot has not got there; "" is `text`."""


@dataclass(frozen=True, slots=True)
class Happening:
    """Something that is done to a robot, or to an object, at a simulated time in s."""

    at_s: float
    robot: str
    command: Command


@dataclass(frozen=True, slots=True)
class Star:
    """A star beyond that of the goal: for a time, a length, or a condition as the file has it; its text for pupils."""

    within_s: float | None = None
    length: int | None = None
    when: object = None
    text: str = ""


@dataclass(frozen=True, slots=True)
class Texts:
    """The texts of a mission in a language; those that are missing are those of the mission itself."""

    title: str = ""
    story: str = ""
    hints: tuple[str, ...] = ()
    facts: Mapping[str, str] = field(default_factory=dict)
    missing: Mapping[str, str] = field(default_factory=dict)
    stars: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Toolbox:
    """What the editors offer, as the teacher's file of the page has it (docs/blockly.md)."""

    hide: tuple[str, ...] = ()
    modes: tuple[str, ...] | None = None


@dataclass(frozen=True, slots=True)
class Mission:
    """A mission. `success` and `failure` are conditions as the file has them; they are checked."""

    title: str
    playground: str
    """Path or name of its playground."""
    facts: Mapping[str, MissionFact]
    success: object
    failure: object = None
    story: str = ""
    picture: str = ""
    """Path of a picture for lists."""
    robot: str = ""
    """The robot that the pupil programs; "" is the first one of the playground."""
    languages: tuple[str, ...] = PROGRAM_LANGUAGES
    programs: Mapping[str, str] = field(default_factory=dict)
    """Path of the program with which a pupil starts, by language."""
    solutions: Mapping[str, str] = field(default_factory=dict)
    """Path of a program that passes with all stars, by language."""
    robots: Mapping[str, str] = field(default_factory=dict)
    """Path or name of the programs of other robots, by robot."""
    toolbox: Toolbox = Toolbox()
    zones: Mapping[str, Zone] = field(default_factory=dict)
    happens: tuple[Happening, ...] = ()
    time_s: float = 120.0
    """Simulated time after which it has failed."""
    stars: tuple[Star, ...] = ()
    hints: tuple[str, ...] = ()
    next: str = ""
    """Path of the mission after this one."""
    translations: Mapping[str, Texts] = field(default_factory=dict)

    @property
    def titles(self) -> dict[str, str]:
        """The title by language."""
        others = {language: texts.title for language, texts in self.translations.items() if texts.title}
        return {"en": self.title} | others

    def text_of(self, fact: str, language: str = "") -> str:
        """The text of a fact in a language, or else its own, or else its name."""
        translated = self.translations.get(language, Texts()).facts.get(fact, "")
        return translated or self.facts[fact].text or fact

    def missing_text(self, fact: str, language: str = "") -> str:
        """What is said of a fact that a pupil has not reached, in a language or else its own."""
        translated = self.translations.get(language, Texts()).missing.get(fact, "")
        return translated or self.facts[fact].missing or self.text_of(fact, language)

    def star_text(self, number: int, language: str = "") -> str:
        """The text of a further star by its number from 0, in a language or else its own."""
        translated = self.translations.get(language, Texts()).stars
        return translated[number] if number < len(translated) else self.stars[number].text

    def hint(self, number: int, language: str = "") -> str:
        """A hint by its number from 0, in a language or else its own; "" if there is none."""
        translated = self.translations.get(language, Texts()).hints
        hints = translated if number < len(translated) else self.hints
        return hints[number] if number < len(hints) else ""
