"""Ground images: pixels of a data URI of a PNG, JPEG or SVG, and PNG files of pixels. The only user of Pillow.

Images are untrusted: sizes are checked before anything is decompressed, those of one image and those of all images of a
playground together (`Budget`). The reasons for Pillow and resvg are in docs/decisions.md.
"""

from __future__ import annotations

import base64
import binascii
import io
import re
import struct
import warnings
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any

import numpy as np

from thymio_sim_ros.sim.formats import svg, svg_process
from thymio_sim_ros.sim.model.fields import FieldError, describe
from thymio_sim_ros.sim.model.optional_import import imported

__all__ = [
    "MAX_PICTURE_BYTES",
    "MAX_PIXELS_IN_ALL",
    "MEDIA_TYPES",
    "Budget",
    "Pixels",
    "budgeted",
    "css_color",
    "data_uri",
    "decode",
    "encode_png",
]

MAX_PICTURE_BYTES = 4_000_000
"""Largest size of an image file."""
MAX_SIDE = 8192
MAX_PIXELS = 25_000_000
"""Largest number of pixels of an image: that of a ground (sim/ground/raster.py)."""
MAX_PIXELS_IN_ALL = 32_000_000
"""Largest number of pixels of all images of a playground; each takes four bytes as long as the playground exists."""
MAX_SVG_BYTES_IN_ALL = 6_000_000
MAX_SCANS = 40
"""Largest number of scans of a JPEG; cameras write one to ten, and each costs as much as the whole image."""

MEDIA_TYPES = {".png": "image/png", ".jpg": "image/jpeg", ".jpeg": "image/jpeg", ".svg": "image/svg+xml"}
"""Ending of a file → media type of its data URI."""

_BAND_PIXELS = 1_000_000

_PILLOW_ERRORS = (OSError, SyntaxError, ValueError, EOFError, OverflowError, struct.error, zlib.error)


@dataclass(slots=True)
class Budget:
    """The remaining budget of all images of one playground together. Invariant: only `decode` reduces it.

    `notes` say what is missing in the images.
    """

    pixels: int = MAX_PIXELS_IN_ALL
    svg_bytes: int = MAX_SVG_BYTES_IN_ALL
    svg_seconds: float = svg_process.MAX_SECONDS
    notes: list[str] = field(default_factory=list)


_budget: ContextVar[Budget] = ContextVar("budget of pictures")
"""A context variable and not an argument, as shapes of other packages decode images, too."""


@contextmanager
def budgeted() -> Iterator[Budget]:
    """Within this context every `decode` of the thread is charged to one budget."""
    token = _budget.set(Budget())
    try:
        yield _budget.get()
    finally:
        _budget.reset(token)


@dataclass(frozen=True, slots=True)
class Pixels:
    """Pixels row by row from the top: bytes red, green, blue, opacity of each."""

    columns: int
    rows: int
    rgba: bytes


def data_uri(data: bytes, media_type: str) -> str:
    """The content of a file as a data URI."""
    return f"data:{media_type};base64,{base64.b64encode(data).decode('ascii')}"


def decode(uri: str, *, key: str, width_m: float) -> Pixels:
    """The pixels of a data URI; an SVG is drawn with the resolution of the ground for `width_m`.

    Raises FieldError, with this key, for anything but a PNG, JPEG or SVG image within the limits.

    Within `budgeted`, all images share its limits; elsewhere each image has them for itself.
    """
    budget = _budget.get(None) or Budget()
    head, _, body = uri.partition(",")
    media_type = head.removeprefix("data:").removesuffix(";base64")
    if media_type not in MEDIA_TYPES.values():
        raise FieldError(key, f"'{media_type[:40]}'", "a data URI of a PNG, JPEG or SVG image")
    try:
        data = base64.b64decode(body, validate=True)
    except (binascii.Error, ValueError) as error:
        raise FieldError(key, "characters that are not base64", "base64") from error
    if len(data) > MAX_PICTURE_BYTES:
        raise FieldError(key, f"{len(data)} bytes", f"an image of at most {MAX_PICTURE_BYTES} bytes")
    if media_type == MEDIA_TYPES[".svg"]:
        budget.svg_bytes -= len(data)
        if budget.svg_bytes < 0:
            found = f"more than {MAX_SVG_BYTES_IN_ALL} bytes of SVG so far"
            raise FieldError(key, found, "fewer or simpler SVG images, or PNG images")
        drawing = svg.draw(data, key, width_m, seconds=budget.svg_seconds)
        budget.svg_seconds -= drawing.seconds
        budget.notes.extend(drawing.notes)
        data = drawing.png
    return _unpack(data, key, budget)


def css_color(value: object, *, key: str) -> str:
    """'#rrggbb' for a CSS color or a number 0xrrggbb. Raises FieldError, with this key, for anything else."""
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
    """A color as Pillow expects it, without opacity: `rgb(1, 2, 3)` for `rgb(1 2 3 / 50%)`."""
    match = re.fullmatch(r"(rgb|hsl)a?\((.*)\)", text.strip(), re.IGNORECASE)
    if match is None:
        return text.strip()
    parts = re.split(r"[\s,/]+", match[2].strip())
    return f"{match[1]}({', '.join(part.removesuffix('deg') for part in parts[:3])})"


def encode_png(pixels: Pixels, *, most: int = MAX_SIDE) -> bytes:
    """The pixels as a PNG file, scaled down if a side has more than `most` pixels.

    Raises FieldError if Pillow is missing.
    """
    # frombuffer copies nothing
    image = _pillow("").frombuffer("RGBA", (pixels.columns, pixels.rows), pixels.rgba, "raw", "RGBA", 0, 1)
    image.thumbnail((most, most))
    out = io.BytesIO()
    image.save(out, "PNG", compress_level=6)
    return out.getvalue()


def _unpack(data: bytes, key: str, budget: Budget) -> Pixels:
    image_module = _pillow(key)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", image_module.DecompressionBombWarning)
            image = image_module.open(io.BytesIO(data), formats=("PNG", "JPEG"))
        columns, rows = image.size
        _check_size(columns, rows, key, budget)
        if image.format == "JPEG":
            _check_scans(data, key)
            # apply the orientation of the camera
            image = imported("PIL.ImageOps", "Pillow", key).exif_transpose(image)
        return _rgba(image, image_module)
    except image_module.DecompressionBombError as error:
        raise FieldError(key, "too many pixels", f"at most {MAX_PIXELS} pixels") from error
    except _PILLOW_ERRORS as error:
        raise FieldError(key, "an image that cannot be read", "a complete PNG or JPEG file") from error


def _check_size(columns: int, rows: int, key: str, budget: Budget) -> None:
    """Check the size in the header, before anything is decompressed, and charge the budget for it."""
    size = f"{columns} x {rows} pixels"
    if max(columns, rows) > MAX_SIDE or columns * rows > MAX_PIXELS:
        raise FieldError(key, size, f"at most {MAX_SIDE} per side and {MAX_PIXELS} in all")
    if columns * rows > budget.pixels:
        found = f"{size}, with {budget.pixels} of {MAX_PIXELS_IN_ALL} left for images of this playground"
        raise FieldError(key, found, "fewer or smaller images; one pixel per millimeter is enough")
    budget.pixels -= columns * rows


def _check_scans(data: bytes, key: str) -> None:
    """Raise FieldError for a progressive JPEG with too many scans."""
    scans = data.count(b"\xff\xda")
    if scans > MAX_SCANS:
        raise FieldError(key, f"a JPEG with {scans} scans", f"at most {MAX_SCANS}")


def _rgba(image: Any, image_module: ModuleType) -> Pixels:
    """The pixels of a Pillow image, converted in bands of rows: Pillow itself needs three times the memory."""
    columns, rows = image.size
    rgba = io.BytesIO()
    height = max(1, _BAND_PIXELS // columns)
    for top in range(0, rows, height):
        band = image.crop((0, top, columns, min(rows, top + height)))
        if band.mode.startswith("I"):
            # Pillow would clip 16-bit grays at 255.
            band = image_module.fromarray((np.asarray(band).astype(np.uint32) >> 8).clip(0, 255).astype(np.uint8))
        rgba.write(band.convert("RGBA").tobytes())
    image.close()
    return Pixels(columns, rows, rgba.getvalue())


def _pillow(key: str) -> ModuleType:
    return imported("PIL.Image", "Pillow", key)
