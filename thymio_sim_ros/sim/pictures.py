"""Ground pictures: a data URI of a PNG, JPEG or SVG → pixels; and pixels → PNG. The only user of Pillow.

Pictures come from strangers: sizes are checked before anything is unpacked. Why Pillow and resvg: docs/decisions.md.
"""

from __future__ import annotations

import base64
import binascii
import io
import re
import struct
import warnings
import zlib
from dataclasses import dataclass
from types import ModuleType

import numpy as np

from thymio_sim_ros.sim import svg
from thymio_sim_ros.sim.fields import FieldError, describe
from thymio_sim_ros.sim.optional import imported

__all__ = ["MAX_PICTURE_BYTES", "MEDIA_TYPES", "Pixels", "css_color", "data_uri", "decode", "encode_png"]

MAX_PICTURE_BYTES = 4_000_000
"""Largest picture as a file."""
MAX_SIDE = 8192
MAX_PIXELS = 25_000_000
"""As many as a ground has at most (sim/ground.py)."""

MEDIA_TYPES = {".png": "image/png", ".jpg": "image/jpeg", ".jpeg": "image/jpeg", ".svg": "image/svg+xml"}
"""Ending of a file → media type of its data URI."""

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
        data = svg.draw(data, key, width_m)
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
        red, green, blue = imported("PIL.ImageColor", "Pillow", key).getrgb(_plain_css(value))[:3]
    except ValueError as error:
        raise FieldError(key, describe(value), "a CSS color such as #bdbbbb") from error
    return "#" + "".join(f"{min(part, 255):02x}" for part in (red, green, blue))


def _plain_css(text: str) -> str:
    """A color as Pillow has it, with commas and without opacity: of `rgb(1 2 3 / 50%)`, `hsla(120deg, 50%, 50%, 1)`."""
    match = re.fullmatch(r"(rgb|hsl)a?\((.*)\)", text.strip(), re.IGNORECASE)
    if match is None:
        return text.strip()
    parts = re.split(r"[\s,/]+", match[2].strip())
    return f"{match[1]}({', '.join(part.removesuffix('deg') for part in parts[:3])})"


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
        if image.format == "JPEG":  # a camera was held upright, perhaps
            image = imported("PIL.ImageOps", "Pillow", key).exif_transpose(image)
        if image.mode.startswith("I"):
            # Pillow would cut 16 bit greys off at 255.
            image = image_module.fromarray((np.asarray(image).astype(np.uint32) >> 8).clip(0, 255).astype(np.uint8))
        columns, rows = image.size
        return Pixels(columns, rows, image.convert("RGBA").tobytes())
    except image_module.DecompressionBombError as error:
        raise FieldError(key, "pixels without measure", f"at most {MAX_PIXELS} pixels") from error
    except _PILLOW_ERRORS as error:
        raise FieldError(key, "a picture that cannot be read", "a whole PNG or JPEG") from error


def _pillow(key: str) -> ModuleType:
    return imported("PIL.Image", "Pillow", key)
