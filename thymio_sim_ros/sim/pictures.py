"""Ground pictures: a data URI of a PNG, JPEG or SVG → pixels; and pixels → PNG. The only importer of decoders.

Pillow reads pixels (Ubuntu has it, most environments too); resvg draws SVG from a wheel of 1.4 MB without any
library of the system, and is needed only where a picture is an SVG. Pictures come from strangers: sizes are checked
before anything is unpacked, and an SVG may hold neither text (fonts differ from machine to machine, and with them
the readings), nor pictures and references to elsewhere, nor filters (their cost has no limit).
"""

from __future__ import annotations

import base64
import binascii
import importlib
import io
import math
import re
import struct
import warnings
import zlib
from dataclasses import dataclass
from types import ModuleType

import numpy as np

from thymio_sim_ros.sim import xml_tree
from thymio_sim_ros.sim.fields import FieldError, describe
from thymio_sim_ros.sim.xml_tree import Element, XmlError

__all__ = ["MAX_PICTURE_BYTES", "MEDIA_TYPES", "Pixels", "css_color", "data_uri", "decode", "encode_png"]

MAX_PICTURE_BYTES = 4_000_000
"""Largest picture as a file."""
MAX_SIDE = 8192
MAX_PIXELS = 25_000_000
"""As many as a ground has at most (sim/ground.py)."""
SVG_PIXEL_M = 0.001
"""An SVG is drawn this fine, like the ground; its edges are smooth all the same."""
MAX_SVG_SIDE = 4096
CSS_DPI = 96.0
"""What a millimetre in an SVG is in pixels; only proportions matter here."""
MAX_SVG_PARTS = 20_000
"""Elements that are drawn, those repeated by <use> counted each time."""

MEDIA_TYPES = {".png": "image/png", ".jpg": "image/jpeg", ".jpeg": "image/jpeg", ".svg": "image/svg+xml"}
"""Ending of a file → media type of its data URI."""

_SVG_REFUSED = {
    "text": "paths (in Inkscape: Path, Object to Path)",
    "image": "shapes and paths, or a PNG instead of the SVG",
    "foreignObject": "shapes and paths",
    "script": "no programs",
    "filter": "no filters",
    "animate": "nothing that moves",
    "animateTransform": "nothing that moves",
    "set": "nothing that moves",
}
_LENGTH = re.compile(r"\s*([0-9.]+(?:[eE][-+]?[0-9]+)?)\s*(?:px|pt|pc|mm|cm|in|q)?\s*", re.IGNORECASE)
_PILLOW_ERRORS = (OSError, SyntaxError, ValueError, EOFError, OverflowError, struct.error, zlib.error)


@dataclass(frozen=True, slots=True)
class Pixels:
    """Pixels row by row from the top, each red, green, blue, opacity from 0 to 255."""

    columns: int
    rows: int
    rgba: bytes


def data_uri(data: bytes, media_type: str) -> str:
    """A file's content as a data URI."""
    return f"data:{media_type};base64,{base64.b64encode(data).decode('ascii')}"


def decode(uri: str, *, key: str, width_m: float) -> Pixels:
    """The pixels of a data URI; an SVG is drawn finely enough for `width_m`. FieldError names `key`."""
    head, _, body = uri.partition(",")
    media_type = head.removeprefix("data:").removesuffix(";base64")
    if media_type not in MEDIA_TYPES.values():
        raise FieldError(key, f"'{media_type[:40]}'", "a data URI of a PNG, JPEG or SVG")
    try:
        data = base64.b64decode(body, validate=True)
    except (binascii.Error, ValueError) as error:
        raise FieldError(key, "characters that are not base64", "base64") from error
    if len(data) > MAX_PICTURE_BYTES:
        raise FieldError(key, f"{len(data)} bytes", f"a picture of at most {MAX_PICTURE_BYTES}")
    if media_type == MEDIA_TYPES[".svg"]:
        data = _draw_svg(data, key, width_m)
    return _unpack(data, key)


def css_color(value: object, *, key: str) -> str:
    """'#rrggbb' for a color as CSS writes it, or as a number 0xrrggbb; FieldError names `key`."""
    if isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= 0xFFFFFF:
        return f"#{value:06x}"
    if isinstance(value, str) and re.fullmatch(r"#[0-9A-Fa-f]{6}", value):
        return value
    try:
        if not isinstance(value, str):
            raise ValueError
        red, green, blue = _module("PIL.ImageColor", "Pillow", key).getrgb(value.strip())[:3]
    except ValueError as error:
        raise FieldError(key, describe(value), "a CSS color such as #bdbbbb") from error
    return f"#{red:02x}{green:02x}{blue:02x}"


def encode_png(pixels: Pixels, *, most: int = MAX_SIDE) -> bytes:
    """The pixels as a PNG file, made smaller where a side has more than `most`."""
    image = _pillow("").frombytes("RGBA", (pixels.columns, pixels.rows), pixels.rgba)
    image.thumbnail((most, most))
    out = io.BytesIO()
    image.save(out, "PNG", compress_level=6)
    return out.getvalue()


def _unpack(data: bytes, key: str) -> Pixels:
    image_module = _pillow(key)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", image_module.DecompressionBombWarning)
            image = image_module.open(io.BytesIO(data), formats=("PNG", "JPEG"))
        columns, rows = image.size
        if max(columns, rows) > MAX_SIDE or columns * rows > MAX_PIXELS:
            expected = f"at most {MAX_SIDE} a side and {MAX_PIXELS} in all"
            raise FieldError(key, f"{columns} x {rows} pixels", expected)
        if image.mode.startswith("I"):
            # Pillow would cut 16 bit greys off at 255.
            image = image_module.fromarray((np.asarray(image).astype(np.uint32) >> 8).clip(0, 255).astype(np.uint8))
        return Pixels(columns, rows, image.convert("RGBA").tobytes())
    except image_module.DecompressionBombError as error:
        raise FieldError(key, "pixels without measure", f"at most {MAX_PIXELS} pixels") from error
    except _PILLOW_ERRORS as error:
        raise FieldError(key, "a picture that cannot be read", "a whole PNG or JPEG") from error


def _draw_svg(data: bytes, key: str, width_m: float) -> bytes:
    """An SVG as the PNG that resvg draws."""
    try:
        root = xml_tree.parse(data)
    except XmlError as error:
        raise FieldError(f"{key} (SVG line {error.line})", error.found, error.expected) from error
    _check_svg(root, key)
    ratio = _height_by_width(root, key)
    columns = round(min(MAX_SVG_SIDE, max(1.0, width_m / SVG_PIXEL_M)))
    columns = min(columns, math.floor(MAX_SVG_SIDE / ratio))
    resvg = _module("resvg_py", "resvg-py", key)
    try:
        drawn: bytes = resvg.svg_to_bytes(
            svg_string=data.decode("utf-8"), width=columns, dpi=CSS_DPI, skip_system_fonts=True
        )
    except ValueError as error:
        raise FieldError(key, f"an SVG that cannot be drawn ({error})", "a whole SVG in UTF-8") from error
    return drawn


def _check_svg(root: Element, key: str) -> None:
    if root.tag != "svg":
        raise FieldError(key, f"<{root.tag}>", "<svg>")
    for element in root.walk():
        where = f"{key} (SVG line {element.line})"
        if element.tag in _SVG_REFUSED:
            raise FieldError(where, f"<{element.tag}>", _SVG_REFUSED[element.tag])
        target = element.attributes.get("href", "#")
        if not target.startswith("#"):
            raise FieldError(where, f"a reference to '{target[:40]}'", "references inside the picture")
    parts = _count_parts(root, {element.attributes.get("id", ""): element for element in root.walk()}, {})
    if parts > MAX_SVG_PARTS:
        raise FieldError(key, f"more than {MAX_SVG_PARTS} elements to draw", "a simpler picture")


def _count_parts(element: Element, by_id: dict[str, Element], known: dict[int, int]) -> int:
    """Elements to draw below one, each <use> counted with what it repeats; a circle of them counts once."""
    number = id(element)
    if number not in known:
        known[number] = 1
        parts = 1 + sum(_count_parts(child, by_id, known) for child in element.children)
        target = by_id.get(element.attributes.get("href", "")[1:]) if element.tag == "use" else None
        if target is not None:
            parts += _count_parts(target, by_id, known)
        known[number] = min(parts, MAX_SVG_PARTS + 1)
    return known[number]


def _height_by_width(root: Element, key: str) -> float:
    box = re.split(r"[\s,]+", root.attributes.get("viewBox", "").strip())
    sides = box[2:] if len(box) == 4 else []
    given = [root.attributes.get(side, "") for side in ("width", "height")]
    if all(_LENGTH.fullmatch(side) for side in given):
        sides = given
    matches = [_LENGTH.fullmatch(side) for side in sides]
    try:
        width, height = (float(match[1]) for match in matches if match)
        ratio = height / width
    except (ValueError, ZeroDivisionError) as error:
        raise FieldError(key, "an SVG without a size", "viewBox, or width and height, in <svg>") from error
    if not 0.01 <= ratio <= 100:
        raise FieldError(key, f"{width:g} x {height:g}", "a width and a height of at most 100 to 1")
    return ratio


def _pillow(key: str) -> ModuleType:
    return _module("PIL.Image", "Pillow", key)


def _module(name: str, package: str, key: str) -> ModuleType:
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise FieldError(key, f"a picture that needs the package {package}", f"`pip install {package}`") from error
