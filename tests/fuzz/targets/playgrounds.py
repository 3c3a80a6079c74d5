"""Playgrounds in JSON, XML and zip archives; pictures in them. Only the process that draws SVG is left out."""

from __future__ import annotations

import gzip
import io
import json
import zipfile
from collections.abc import Iterator
from typing import Any
from unittest.mock import patch

from tests.fuzz.target import Target, text
from tests.sim.builders import PLAYGROUNDS
from tests.sim.images import BLACK, CLEAR, RED, WHITE, png, png_uri, svg_uri
from tests.sim.playground.importers.test_thesis import BORDERLESS
from tests.sim.test_playground_fuzz import ASEBA
from thymio_sim_ros.files.loading import is_playground_text, load_playground
from thymio_sim_ros.sim.formats import css, image_io, svg, svg_process, xml_tree
from thymio_sim_ros.sim.formats.xml_tree import XmlError
from thymio_sim_ros.sim.model.fields import FieldError
from thymio_sim_ros.sim.playground import reader
from thymio_sim_ros.sim.playground.format_detection import unpacked_svg
from thymio_sim_ros.sim.playground.model import PlaygroundError
from thymio_sim_ros.sim.playground.writer import dumps

PIXEL = png([[WHITE, BLACK], [RED, CLEAR]])
PARTS = ('"format":1', '"shapes":[', '"kind":', '"robots":[', '"size_x_m":', "1e308", "-1", "NaN", "\\ud800", "data:,")
SVG = ("<use", 'href="#a"', "url(#a)", "style=", "viewBox=", "<clipPath", "&#", "<!ENTITY", "xmlns:x=", "@import", "\\")


def _drawn(_text: str, _resvg: Any, *, seconds: float) -> tuple[bytes, float]:
    """In place of the process that draws."""
    return PIXEL, min(seconds, 0.01)


def _playground(data: bytes) -> None:
    with patch.object(svg_process, "draw", _drawn):
        loaded = reader.loads(data, "fuzz.json")
        assert reader.loads(dumps(loaded), "fuzz.json").shapes == loaded.shapes


def _parameter(data: bytes) -> None:
    """What a client gives as the parameter `playground`, unless it is a path."""
    value = text(data)
    if is_playground_text(value):
        with patch.object(svg_process, "draw", _drawn):
            load_playground(value)


def _picture(data: bytes) -> None:
    kind, _, body = data.partition(b"\n")
    media_type = "image/jpeg" if kind == b"j" else "image/png"
    image_io.decode(image_io.data_uri(body, media_type), key="image", width_m=0.5)


def _svg(data: bytes) -> None:
    with patch.object(svg_process, "draw", _drawn):
        svg.draw(data, "image", 0.5, seconds=1.0)


def _from(path_name: str) -> bytes:
    return json.dumps(json.loads((PLAYGROUNDS / path_name).read_bytes())).encode()


def _files() -> Iterator[bytes]:
    yield from (_from(f"{name}.json") for name in ("desk", "gate", "obstacle", "two_robots"))
    yield ASEBA.encode()
    yield json.dumps(BORDERLESS).encode()


def _archives() -> Iterator[bytes]:
    with_picture = ASEBA.replace("<world ", '<world groundTexture="a.png" ')
    for content in ({"world.xml": ASEBA.encode()}, {"world.xml": with_picture.encode(), "a.png": PIXEL}):
        for method in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            packed = io.BytesIO()
            with zipfile.ZipFile(packed, "w", method) as archive:
                for name, data in content.items():
                    archive.writestr(name, data)
            yield packed.getvalue()


def _parameters() -> Iterator[bytes]:
    print_ = {"kind": "picture", "image": png_uri([[RED]]), "size_x_m": 0.1, "size_y_m": 0.1}
    yield json.dumps({"format": 1, "title": "a", "shapes": [print_]}).encode()
    yield json.dumps({"format": 1, "title": "a", "shapes": [print_ | {"image": svg_uri("<g/>")}]}).encode()
    yield b"data:;name=my.json;base64,eyJmb3JtYXQiOjF9"


def _pictures() -> Iterator[bytes]:
    yield b"p\n" + PIXEL
    image = image_io._pillow("").open(io.BytesIO(PIXEL))
    for mode in ("RGB", "L"):
        for progressive in (False, True):
            out = io.BytesIO()
            image.convert(mode).save(out, "JPEG", progressive=progressive)
            yield b"j\n" + out.getvalue()
    for mode in ("I;16", "P", "1", "LA"):
        out = io.BytesIO()
        image.convert("L").convert("I").convert(mode).save(out, "PNG") if mode == "I;16" else image.convert(mode).save(
            out, "PNG"
        )
        yield b"p\n" + out.getvalue()


def _svgs() -> Iterator[bytes]:
    head = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 100 50">'
    for body in (
        '<rect width="100%" height="50" style="fill:red;filter:none"/>',
        '<defs><g id="a"><path d="M0 0h9"/></g></defs><use xlink:href="#a"/><use href="#a" clip-path="url(#a)"/>',
        "<style>.a{fill:blue} @media print{.a{mix-blend-mode:normal !important}}</style>",
    ):
        yield (head + body + "</svg>").encode()
    yield (PLAYGROUNDS / "line_gradient.svg").read_bytes()[:4096]


TARGETS = (
    Target("playground", _playground, (PlaygroundError,), _files, PARTS),
    Target("playground-zip", _playground, (PlaygroundError,), _archives, ("world.xml", "../", "PK\x01\x02")),
    Target("playground-parameter", _parameter, (PlaygroundError,), _parameters, PARTS),
    Target("picture", _picture, (FieldError,), _pictures, ("IHDR", "PLTE", "tRNS", "eXIf", "acTL", "Exif")),
    Target("svg", _svg, (FieldError,), _svgs, SVG),
    Target("svgz", unpacked_svg, (FieldError,), lambda: map(gzip.compress, _svgs())),
    Target(
        "css", lambda data: css.parse(text(data), {"filter", "mask"}), (), lambda: [b"filter:none;mask:url( 'a' )"], SVG
    ),
    Target("xml", xml_tree.parse, (XmlError,), _svgs, SVG),
)
