"""Reads the file of a mission (docs/missions.md): JSON, without code.

Errors name the file, the key, what was found and what was expected.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.missions.conditions import read_condition
from thymio_sim_ros.missions.facts import FACTS
from thymio_sim_ros.missions.file_fields import (
    FORMAT,
    MAX_FACTS,
    MAX_HAPPENINGS,
    MAX_HINTS,
    MAX_STARS,
    MAX_TOOLS,
    MAX_ZONES,
    NAME,
    PROXIMITY,
    FactHead,
    HappeningFields,
    Head,
    StarFields,
    TextFields,
)
from thymio_sim_ros.missions.files import MAX_PICTURE_BYTES, Files, is_archive, unpack
from thymio_sim_ros.missions.mission import PROGRAM_LANGUAGES, Happening, Mission, MissionFact, Star, Texts, Toolbox
from thymio_sim_ros.missions.zones import ZONES, Zone
from thymio_sim_ros.sim.commands import Clap, Command, MoveObject, PressButton, SetProximity, Tap
from thymio_sim_ros.sim.formats.json_text import parse_json
from thymio_sim_ros.sim.model.fields import LANGUAGE, FieldError, Text, describe, join, nearest, read

__all__ = ["MissionError", "load_mission"]

MAX_BYTES = 1_000_000
_ACTIONS = ("press", "release", "tap", "clap", "hand", "move")
_NEAR, _AS_MEASURED = 4200, -1
"""Counts of a proximity sensor with a hand right in front of it, and of one without."""

T = TypeVar("T")


class MissionError(ThymioSimError):
    """A mission file that is refused: its path, the key, what was found and what was expected."""

    def __init__(self, path: str, error: FieldError) -> None:
        super().__init__(f"{path}: {error}")
        self.path = path
        self.key = error.key
        self.found = error.found
        self.expected = error.expected


def load_mission(path: Path, *, folder: Path | None = None) -> Mission:
    """Read a mission file, or a zip with one and all that it needs; paths in it start in its folder.

    A zip is unpacked into a folder that is there until the process ends. With `folder`, for the file of a client, it is
    unpacked there, and a mission may name no files outside of its own folder. Raises MissionError, OSError.
    """
    data = path.read_bytes()
    try:
        files = Files(path.parent, is_closed=folder is not None)
        if is_archive(data):
            inside = unpack(data, folder)
            data, files = inside.read_bytes(), Files(inside.parent, is_closed=True)
        if len(data) > MAX_BYTES:
            raise FieldError("", f"{len(data)} bytes", f"at most {MAX_BYTES}")
        return _mission(parse_json(data), files)
    except FieldError as error:
        raise MissionError(str(path), error) from error


def _mission(data: object, files: Files) -> Mission:
    members = dict(_object(data, ""))
    version = members.pop("format", None)
    if version != FORMAT or isinstance(version, bool):
        raise FieldError("format", describe(version), str(FORMAT))
    members.pop("$schema", None)
    languages = _languages(members.pop("languages", list(PROGRAM_LANGUAGES)))
    zones = dict(_named(members.pop("zones", {}), "zones", MAX_ZONES, _zone))
    facts = dict(_named(members.pop("facts", {}), "facts", MAX_FACTS, _fact))
    hints = _texts(members.pop("hints", []), "hints")
    happens = tuple(_happening(*item) for item in _items(members.pop("happens", []), "happens", MAX_HAPPENINGS))
    stars = tuple(_star(*item, facts) for item in _items(members.pop("stars", []), "stars", MAX_STARS))
    programs = _programs(members.pop("programs", {}), "programs", languages, files)
    solutions = _programs(members.pop("solutions", {}), "solutions", languages, files)
    robots = {
        robot: files.find_or_name(f"robots.{robot}", _text(program, f"robots.{robot}"))
        for robot, program in _object(members.pop("robots", {}), "robots").items()
    }
    toolbox = _toolbox(members.pop("toolbox", {}))
    translations = {
        language: _translation(texts, f"translations.{language}", facts, len(stars))
        for language, texts in _object(members.pop("translations", {}), "translations").items()
    }
    success, failure = members.pop("success", None), members.pop("failure", None)
    if success is None:
        raise FieldError("success", "nothing", "a condition")
    read_condition(success, "success", facts)
    if failure is not None:
        read_condition(failure, "failure", facts)
    head = read(Head, members, "")
    return Mission(
        title=head.title,
        playground=files.find_or_name("playground", head.playground),
        facts=facts,
        success=success,
        failure=failure,
        story=head.story,
        picture=files.find("picture", head.picture, longest=MAX_PICTURE_BYTES) if head.picture else "",
        robot=head.robot,
        languages=languages,
        programs=programs,
        solutions=solutions,
        robots=robots,
        toolbox=toolbox,
        zones=zones,
        happens=tuple(sorted(happens, key=lambda each: each.at_s)),
        time_s=head.time_s,
        stars=stars,
        hints=hints,
        next=files.find_or_name("next", head.next) if head.next else "",
        translations=translations,
    )


def _zone(data: object, key: str) -> Zone:
    return read(*_kind(data, key, ZONES), key)


def _fact(data: object, key: str) -> MissionFact:
    kind, members = _kind(data, key, FACTS)
    head = read(FactHead, {name: members.pop(name) for name in ("robot", "text", "missing") if name in members}, key)
    return MissionFact(read(kind, members, key), head.robot, head.text, head.missing)


def _kind(data: object, key: str, kinds: Mapping[str, type[T]]) -> tuple[type[T], dict[str, Any]]:
    """The class of the member "kind", and the other members."""
    members = dict(_object(data, key))
    kind = members.pop("kind", None)
    if not isinstance(kind, str) or kind not in kinds:
        raise FieldError(join(key, "kind"), describe(kind), nearest(str(kind), tuple(kinds)))
    return kinds[kind], members


def _happening(data: object, key: str) -> Happening:
    found = read(HappeningFields, data, key)
    done = [action for action in _ACTIONS if getattr(found, action) not in (None, False)]
    if len(done) != 1:
        raise FieldError(key, ", ".join(done) or "nothing", f"one of {', '.join(_ACTIONS)}")
    command: Command
    if found.press is not None:
        command = PressButton(found.press, True)
    elif found.release is not None:
        command = PressButton(found.release, False)
    elif found.hand is not None:
        counts = [_NEAR if name == found.hand else _AS_MEASURED for name in PROXIMITY]
        command = SetProximity(tuple(counts))
    elif found.move is not None:
        if found.x_m is None or found.y_m is None:
            raise FieldError(key, f"'{found.move}' without a place", "x_m and y_m")
        return Happening(found.at_s, found.move, MoveObject(found.x_m, found.y_m, found.yaw_rad))
    else:
        command = Tap() if found.clap is None else Clap(round(found.clap))
    return Happening(found.at_s, found.robot, command)


def _star(data: object, key: str, facts: Mapping[str, MissionFact]) -> Star:
    members = dict(_object(data, key))
    when = members.pop("when", None)
    found = read(StarFields, members, key)
    given = [name for name, value in (("within_s", found.within_s), ("length", found.length), ("when", when)) if value]
    if len(given) != 1:
        raise FieldError(key, ", ".join(given) or "nothing", "one of within_s, length, when")
    if when is not None:
        read_condition(when, join(key, "when"), facts)
    return Star(found.within_s, None if found.length is None else round(found.length), when, found.text)


def _translation(data: object, key: str, facts: Mapping[str, MissionFact], stars: int) -> Texts:
    if not re.fullmatch(LANGUAGE, key.rpartition(".")[2]):
        raise FieldError(key, describe(key.rpartition(".")[2]), "a language code such as de")
    members = dict(_object(data, key))
    hints = _texts(members.pop("hints", []), join(key, "hints"))
    texts: dict[str, dict[str, str]] = {"facts": {}, "missing": {}}
    for group, found in texts.items():
        for name, text in _object(members.pop(group, {}), join(key, group)).items():
            place = join(join(key, group), name)
            if name not in facts:
                raise FieldError(place, "an unknown fact", nearest(name, tuple(facts)))
            found[name] = _text(text, place)
    of_stars = tuple(_text(*item) for item in _items(members.pop("stars", []), join(key, "stars"), stars))
    head = read(TextFields, members, key)
    return Texts(head.title, head.story, hints, texts["facts"], texts["missing"], of_stars)


def _programs(data: object, key: str, languages: Sequence[str], files: Files) -> dict[str, str]:
    found = {}
    for language, name in _object(data, key).items():
        place = join(key, language)
        if language not in languages:
            raise FieldError(place, "an unknown language", nearest(language, languages))
        found[language] = files.find(place, _text(name, place))
    return found


def _toolbox(data: object) -> Toolbox:
    found = {}
    for word, names in _object(data, "toolbox").items():
        if word not in ("hide", "modes"):
            raise FieldError(f"toolbox.{word}", "an unknown key", nearest(word, ("hide", "modes")))
        found[word] = tuple(_text(*item) for item in _items(names, f"toolbox.{word}", MAX_TOOLS))
    return Toolbox(**found)


def _languages(data: object) -> tuple[str, ...]:
    if not isinstance(data, list) or not data:
        raise FieldError("languages", describe(data), f"a list of {', '.join(PROGRAM_LANGUAGES)}")
    for index, language in enumerate(data):
        if language not in PROGRAM_LANGUAGES:
            raise FieldError(f"languages[{index}]", describe(language), nearest(str(language), PROGRAM_LANGUAGES))
        if language in data[:index]:
            raise FieldError(f"languages[{index}]", f"{describe(language)} again", "each language once")
    return tuple(data)


def _named(data: object, key: str, most: int, read_one: Callable[[object, str], T]) -> Iterator[tuple[str, T]]:
    items = _object(data, key)
    if len(items) > most:
        raise FieldError(key, f"{len(items)} of them", f"at most {most}")
    for name, value in items.items():
        if not NAME.fullmatch(name):
            raise FieldError(join(key, name), "this name", "letters, digits and single underscores, a letter first")
        yield name, read_one(value, join(key, name))


def _items(data: object, key: str, most: int) -> Iterator[tuple[object, str]]:
    if not isinstance(data, list) or len(data) > most:
        raise FieldError(key, describe(data), f"a list of at most {most}")
    return ((value, f"{key}[{index}]") for index, value in enumerate(data))


def _texts(data: object, key: str) -> tuple[str, ...]:
    return tuple(_text(text, place) for text, place in _items(data, key, MAX_HINTS))


@dataclass(frozen=True, slots=True)
class _OneText:
    text: Text


def _text(data: object, key: str) -> str:
    try:
        return read(_OneText, {"text": data}, "").text
    except FieldError as error:
        raise FieldError(key, error.found, error.expected) from error


def _object(data: object, key: str) -> Mapping[str, Any]:
    if not isinstance(data, Mapping):
        raise FieldError(key, describe(data), "an object")
    return data
