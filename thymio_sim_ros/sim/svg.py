"""An SVG picture as pixels, drawn by resvg; refused where its cost or its look would depend on something else.

It may hold neither text (fonts differ from machine to machine, and with them the readings), nor pictures and references
to elsewhere, nor filters and markers (their cost has no limit).
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from thymio_sim_ros.sim import xml_tree
from thymio_sim_ros.sim.fields import FieldError
from thymio_sim_ros.sim.optional import imported
from thymio_sim_ros.sim.xml_tree import Element, XmlError

__all__ = ["draw"]

PIXEL_M = 0.001
"""An SVG is drawn this fine, like the ground; its edges are smooth all the same."""
MAX_SIDE = 4096
CSS_DPI = 96.0
"""What a millimetre in an SVG is in pixels; only proportions matter here."""
MAX_PIXELS = 6_000_000
MAX_PARTS = 20_000
"""Elements that are drawn, repeated ones counted each time."""
MAX_DEPTH = 40
"""Elements inside one another, references counted; each may hold a picture of its own while it is drawn."""

_REFUSED = {
    "text": "paths (in Inkscape: Path, Object to Path)",
    "image": "shapes and paths, or a PNG instead of the SVG",
    "foreignObject": "shapes and paths",
    "script": "no programs",
    "marker": "no markers, or markers turned into paths",
    "filter": "no filters",
    "animate": "nothing that moves",
    "animateTransform": "nothing that moves",
    "set": "nothing that moves",
}
_URL = re.compile(r"url\(\s*['\"]?#([^)'\"]+)")
_LENGTH = re.compile(r"\s*([0-9.]+(?:[eE][-+]?[0-9]+)?)\s*(?:px|pt|pc|mm|cm|in|q)?\s*", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class _Weight:
    """Elements that are drawn, and how many of them lie inside one another."""

    parts: int
    depth: int


_ENDLESS = _Weight(MAX_PARTS + 1, 1)


def draw(data: bytes, key: str, width_m: float) -> bytes:
    """An SVG as the PNG that resvg draws, finely enough for `width_m`; FieldError names `key`."""
    try:
        root = xml_tree.parse(data)
    except XmlError as error:
        raise FieldError(f"{key} (SVG line {error.line})", error.found, error.expected) from error
    _check(root, key)
    ratio = _height_by_width(root, key)
    columns = round(min(MAX_SIDE, max(1.0, width_m / PIXEL_M)))
    columns = math.floor(min(columns, MAX_SIDE / ratio, math.sqrt(MAX_PIXELS / ratio)))
    resvg = imported("resvg_py", "resvg-py", key)
    try:
        drawn: bytes = resvg.svg_to_bytes(
            svg_string=data.decode("utf-8"), width=columns, dpi=CSS_DPI, skip_system_fonts=True
        )
    except ValueError as error:
        raise FieldError(key, f"an SVG that cannot be drawn ({error})", "a whole SVG in UTF-8") from error
    return drawn


def _check(root: Element, key: str) -> None:
    if root.tag != "svg":
        raise FieldError(key, f"<{root.tag}>", "<svg>")
    for element in root.walk():
        where = f"{key} (SVG line {element.line})"
        if element.tag in _REFUSED:
            raise FieldError(where, f"<{element.tag}>", _REFUSED[element.tag])
        target = element.attributes.get("href", "#")
        if not target.startswith("#"):
            raise FieldError(where, f"a reference to '{target[:40]}'", "references inside the picture")
        if element.tag == "style" and "url(" in element.text:
            raise FieldError(where, "url(…) in <style>", "references in the attributes of elements")
    by_id: dict[str, list[Element]] = {}
    for element in root.walk():
        by_id.setdefault(element.attributes.get("id", ""), []).append(element)
    _weigh(root, by_id, {}, key)


def _weigh(
    element: Element, by_id: dict[str, list[Element]], known: dict[int, _Weight], key: str, above: int = 0
) -> _Weight:
    """What it costs to draw an element, with all that it repeats, fills or cuts itself with.

    Each thing is drawn anew for each reference to it, and what lies inside one another is held at the same time;
    both could grow without measure. A circle of references has no end at all.
    """
    if above > MAX_DEPTH:
        raise FieldError(key, f"elements more than {MAX_DEPTH} deep", "a simpler picture")
    weight = known.get(id(element))
    if weight is None:
        known[id(element)] = _ENDLESS
        named = [other for name in _references(element) if name for other in by_id.get(name, ())]
        inner = [_weigh(other, by_id, known, key, above + 1) for other in (*element.children, *named)]
        weight = known[id(element)] = _Weight(
            1 + sum(one.parts for one in inner), 1 + max((one.depth for one in inner), default=0)
        )
    if weight.parts > MAX_PARTS:
        raise FieldError(key, f"more than {MAX_PARTS} elements to draw", "a simpler picture")
    if above + weight.depth > MAX_DEPTH:
        raise FieldError(key, f"elements more than {MAX_DEPTH} deep", "a simpler picture")
    return weight


def _references(element: Element) -> list[str]:
    """Ids of the elements that this one is drawn with."""
    found = [name for value in element.attributes.values() for name in _URL.findall(value)]
    if element.tag == "use":
        found.append(element.attributes.get("href", "")[1:])
    return found


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
