"""Playground files: JSON text → a frozen `Playground`, or a `PlaygroundError` that says where and why.

Format 1: `format`, `title`, `description`, `translations`, `shapes` (each with `kind`, optional `name`, and the
fields of its kind, see `sim/shapes`), `robots` (`name`, `x_m`, `y_m`, `yaw_rad`, `pen`). Data only, SI units; unknown
keys are refused.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from thymio_sim_ros.sim.formats import image_io
from thymio_sim_ros.sim.model import fields
from thymio_sim_ros.sim.model.fields import (
    LANGUAGE,
    FieldError,
    Name,
    Text,
    describe,
    join,
    json_schema,
    read,
)
from thymio_sim_ros.sim.model.primitives import Floor, Paint, Primitive, Print, Solid, Trigger
from thymio_sim_ros.sim.playground import checks as checks
from thymio_sim_ros.sim.playground import format_detection
from thymio_sim_ros.sim.playground.format_detection import MAX_BYTES, Beside
from thymio_sim_ros.sim.playground.model import (
    Headline,
    NamedShape,
    PenStart,
    Playground,
    PlaygroundError,
    RobotStart,
    Translation,
)
from thymio_sim_ros.sim.playground.start_poses import set_free
from thymio_sim_ros.sim.shapes import ShapeKind, all_shapes, primitives_of

__all__ = [
    "Headline",
    "NamedShape",
    "PenStart",
    "Playground",
    "PlaygroundError",
    "RobotStart",
    "Translation",
    "headline",
    "load",
    "loads",
    "schema",
]

FORMAT = 1
SVGZ = ".svgz"
"""Ending of an SVG packed with gzip; it is unpacked at once."""
MAX_SHAPES = 1000
MAX_ROBOTS = 1000
MAX_PRIMITIVES = 10_000
MAX_TRANSLATIONS = 50
MAX_PICTURES_BYTES = 24_000_000
"""Of all pictures together as text; the rest of a file of `MAX_BYTES` is for what else it says."""


@dataclass(frozen=True, slots=True)
class _Titles:
    title: Text
    description: Text = ""


def load(path: str | Path, part: str = "") -> Playground:
    """Read a playground file; it is named after the file. Raises PlaygroundError, also if it cannot be read.

    `part` names a playground of an archive with several; it is named after that one.
    """
    path = Path(path)
    return _read(_content(path), path.stem, str(path), format_detection.folder(path.parent), part)


def headline(path: Path) -> Headline:
    """Title and description of a file without building the playground. Raises PlaygroundError."""
    try:
        found = format_detection.read_source(_content(path), path.stem, format_detection.folder(path.parent))
        members = _members(found.data)
        wanted = {key: members[key] for key in ("title", "description") if key in members}
        titles = read(_Titles, wanted, "")
        return Headline(titles.title, titles.description, _translations(members.get("translations", {})))
    except FieldError as error:
        raise PlaygroundError(str(path), error.key, error.found, error.expected) from error


def loads(text: str | bytes, name: str, part: str = "") -> Playground:
    """Read a playground from a text or the bytes of a file; there are no files beside it. `part` is that of `load`.

    Raises PlaygroundError with `name` as its path.
    """
    try:
        data = text if isinstance(text, bytes) else text.encode("utf-8")
    except UnicodeEncodeError as error:
        raise PlaygroundError(name, "", f"an unpaired surrogate at {error.start}", "UTF-8 text") from error
    return _read(data, Path(name).stem, name, format_detection.nothing_beside, part)


def schema() -> dict[str, Any]:
    """The JSON schema of playground files, derived from the shapes; `description` states units."""
    kinds = all_shapes()
    name = json_schema(RobotStart)["properties"]["name"]
    shapes = []
    for kind in kinds:
        form = json_schema(kind.form, extra={"kind": {"const": kind.name}})
        form["properties"]["name"] = name
        shapes.append(form)
    top = json_schema(_Titles, extra={"format": {"const": FORMAT}})
    top["properties"]["$schema"] = {"type": "string", "description": "where an editor finds this schema"}
    top["properties"]["translations"] = {
        "type": "object",
        "patternProperties": {f"^{LANGUAGE}$": json_schema(Translation)},
        "additionalProperties": False,
        "maxProperties": MAX_TRANSLATIONS,
        "description": "title and description in other languages",
    }
    top["properties"]["shapes"] = {"type": "array", "maxItems": MAX_SHAPES, "items": {"oneOf": shapes}}
    top["properties"]["robots"] = {"type": "array", "maxItems": MAX_ROBOTS, "items": json_schema(RobotStart)}
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "Thymio playground", **top}


def _content(path: Path) -> bytes:
    try:
        with path.open("rb") as file:
            return file.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:
        found = getattr(error, "strerror", None) or "an error"
        raise PlaygroundError(str(path), "", found, "a readable file") from error


def _members(data: object) -> dict[str, object]:
    """The members of a playground without the version, which must be FORMAT."""
    if not isinstance(data, Mapping):
        raise FieldError("", describe(data), "an object")
    members = dict(data)
    version = members.pop("format", None)
    if version != FORMAT or isinstance(version, bool):
        raise FieldError("format", describe(version), str(FORMAT))
    editor = members.pop("$schema", "")
    if not isinstance(editor, str):
        raise FieldError("$schema", describe(editor), "a string (only editors read it)")
    return members


def _read(data: bytes, name: str, path: str, beside: Beside, part: str) -> Playground:
    places: Mapping[str, str] = {}
    try:
        found = format_detection.read_source(data, name, beside, part)
        places = found.places
        return _build(found, Path(part).stem or name)
    except FieldError as error:
        raise PlaygroundError(path, _original(error.key, places), error.found, error.expected) from error


def _original(key: str, places: Mapping[str, str]) -> str:
    """A key of a converted file with its place in the original."""
    item = key.partition(".")[0]
    return f"{places[item]} ({key})" if item in places else key


def _build(found: format_detection.Source, name: str) -> Playground:
    members, beside, notes = _members(found.data), found.beside, found.notes
    shape_items = _items(members.pop("shapes", []), "shapes", MAX_SHAPES)
    robot_items = _items(members.pop("robots", []), "robots", MAX_ROBOTS)
    translations = _translations(members.pop("translations", {}))
    titles = read(_Titles, members, "")
    kinds = {kind.name: kind for kind in all_shapes()}
    shapes = tuple(_shape(item, index, kinds, beside) for index, item in enumerate(shape_items))
    _check_pictures(shapes)
    robots = tuple(read(RobotStart, item, f"robots[{index}]") for index, item in enumerate(robot_items))
    checks.check_names(shapes, robots)
    with image_io.budgeted() as budget:
        primitives = _primitives(shapes, budget.notes)
    notes += tuple(_picture_note(note, found.places) for note in dict.fromkeys(budget.notes))
    solids = tuple(primitive for primitive in primitives if isinstance(primitive, Solid))
    floors = tuple(primitive for primitive in primitives if isinstance(primitive, Floor))
    if found.sets_free:
        robots, freed = set_free(robots, solids, floors)
        notes += freed
    checks.check_starts(robots, solids)
    checks.check_doors(shapes, primitives)
    paints = tuple(primitive for primitive in primitives if isinstance(primitive, Paint | Print))
    checks.check_ground(floors, paints)
    return Playground(
        name=name,
        title=titles.title,
        description=titles.description,
        shapes=shapes,
        robots=robots,
        solids=solids,
        floors=floors,
        paints=paints,
        translations=translations,
        triggers=tuple(primitive for primitive in primitives if isinstance(primitive, Trigger)),
        notes=(*notes, *checks.off_floor(robots, solids, floors)),
    )


def _translations(value: object) -> tuple[tuple[str, Translation], ...]:
    if not isinstance(value, Mapping) or len(value) > MAX_TRANSLATIONS:
        raise FieldError("translations", describe(value), f"an object with at most {MAX_TRANSLATIONS} languages")
    for language in value:
        if not re.fullmatch(LANGUAGE, language):
            raise FieldError(f"translations.{language}", describe(language), "a language code such as de")
    return tuple((language, read(Translation, text, f"translations.{language}")) for language, text in value.items())


def _items(value: object, key: str, most: int) -> list[object]:
    if not isinstance(value, list):
        raise FieldError(key, describe(value), "a list")
    if len(value) > most:
        raise FieldError(key, f"{len(value)} items", f"at most {most}")
    return value


def _shape(item: object, index: int, kinds: Mapping[str, ShapeKind], beside: Beside) -> NamedShape:
    key = f"shapes[{index}]"
    if not isinstance(item, Mapping):
        raise FieldError(key, describe(item), "an object")
    members = dict(item)
    kind = members.pop("kind", None)
    if not isinstance(kind, str) or kind not in kinds:
        raise FieldError(f"{key}.kind", describe(kind), fields.nearest(str(kind), tuple(kinds)))
    name = read(_Label, {"name": members.pop("name", f"{kind}_{index}")}, key).name
    form = kinds[kind].form
    for image in fields.image_keys(form):
        if image in members:
            members[image] = _embedded(members[image], join(key, image), beside)
    return NamedShape(kind, name, read(form, members, key))


def _check_pictures(shapes: tuple[NamedShape, ...]) -> None:
    """Raise FieldError for more images than one file may hold, so that a playground can be written as one file."""
    size = 0
    for index, named in enumerate(shapes):
        for image in fields.image_keys(type(named.shape)):
            size += len(getattr(named.shape, image) or "")
            if size > MAX_PICTURES_BYTES:
                found = f"more than {MAX_PICTURES_BYTES} bytes of images as base64"
                raise FieldError(f"shapes[{index}].{image}", found, "fewer or smaller images")


def _embedded(value: object, key: str, beside: Beside) -> object:
    """The name of an image file as a data URI of its content; anything else unchanged."""
    if not isinstance(value, str) or value.startswith("data:"):
        return value
    suffix = Path(value).suffix.lower()
    is_packed = suffix == SVGZ
    media_type = image_io.MEDIA_TYPES.get(".svg" if is_packed else suffix)
    if media_type is None:
        raise FieldError(key, describe(value), "a file that ends in " + ", ".join((*image_io.MEDIA_TYPES, SVGZ)))
    try:
        data = beside(value)
        return image_io.data_uri(format_detection.unpacked_svg(data) if is_packed else data, media_type)
    except FieldError as error:
        raise FieldError(key, error.found, error.expected) from error


@dataclass(frozen=True, slots=True)
class _Label:
    name: Name


def _picture_note(note: str, places: Mapping[str, str]) -> str:
    """A note about an image of a shape with the place of the shape in the original."""
    item, _, rest = note.partition(".")
    return f"{places[item]}: {rest}" if item in places else note


def _primitives(shapes: tuple[NamedShape, ...], notes: list[str]) -> list[Primitive]:
    """The parts of the shapes; notes that are added to `notes` get the shape in front."""
    found: list[Primitive] = []
    for index, named in enumerate(shapes):
        known = len(notes)
        try:
            found.extend(primitives_of(named.kind, named.shape, named.name))
        except FieldError as error:
            key = f"shapes[{index}].{error.key}".removesuffix(".")
            raise FieldError(key, error.found, error.expected) from error
        notes[known:] = [f"shapes[{index}].{note}" for note in notes[known:]]
        if len(found) > MAX_PRIMITIVES:
            raise FieldError(f"shapes[{index}]", f"more than {MAX_PRIMITIVES} parts", "a simpler playground")
    return found
