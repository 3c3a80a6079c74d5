"""SVG images as pixels, drawn by resvg; rejected if their cost has no limit or their look depends on the machine.

An SVG may contain no text (fonts, and with them readings, differ between machines), no images and external references,
and no filters, masks, blend modes and markers (their cost has no limit), be it as elements, attributes or CSS. These
checks give clear messages; everything else is limited by the drawing process (`svg_process`).
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass

from thymio_sim_ros.sim.formats import css, svg_process, xml_tree
from thymio_sim_ros.sim.formats.css import Style
from thymio_sim_ros.sim.formats.svg_process import DrawError
from thymio_sim_ros.sim.formats.svg_worker import CSS_DPI
from thymio_sim_ros.sim.formats.xml_tree import Element, XmlError
from thymio_sim_ros.sim.model.fields import FieldError
from thymio_sim_ros.sim.model.optional_import import imported

__all__ = ["draw"]

PIXEL_M = 0.001
"""Size of a pixel of a drawn SVG in m, that of the ground; edges are anti-aliased."""
MAX_SIDE = 4096
MAX_PIXELS = 6_000_000
MAX_PARTS = 20_000
"""Largest number of elements that are drawn, repeated ones counted each time."""
MAX_DEPTH = 40
"""Largest depth of nested elements, references included; each may need a buffer while it is drawn."""

_REFUSED = {
    "text": "paths (in Inkscape: Path > Object to Path)",
    "image": "shapes and paths, or a PNG instead of the SVG",
    "foreignObject": "shapes and paths",
    "script": "no scripts",
    "marker": "no markers (convert them to paths)",
    "filter": "no filters",
    "mask": "no masks (clip paths are allowed)",
    "animate": "no animation",
    "animateTransform": "no animation",
    "set": "no animation",
}
_EFFECTS = {
    "filter": "no filters",
    "backdrop-filter": "no filters",
    "mask": "no masks (clip paths are allowed)",
    "mask-image": "no masks (clip paths are allowed)",
    "mask-border": "no masks (clip paths are allowed)",
    "mask-border-source": "no masks (clip paths are allowed)",
    "mask-box-image": "no masks (clip paths are allowed)",
    "mix-blend-mode": "no blend modes",
    "isolation": "no isolated groups",
    "marker": "no markers (convert them to paths)",
    "marker-start": "no markers (convert them to paths)",
    "marker-mid": "no markers (convert them to paths)",
    "marker-end": "no markers (convert them to paths)",
}
"""Properties that are rejected, as attributes and in CSS, except with a value of `_WITHOUT_EFFECT`."""
_WITHOUT_EFFECT = frozenset({"none", "auto", "normal", "initial", "unset"})
"""Inkscape writes `filter:none;mix-blend-mode:normal;isolation:auto` into every style."""
MAX_STYLES = 300_000
"""Largest number of characters of CSS, equal styles counted once."""
_HREFS = ("href", "xlink:href")
_LENGTH = re.compile(r"\s*([0-9.]+(?:[eE][-+]?[0-9]+)?)\s*(px|pt|pc|mm|cm|in|q)?\s*", re.IGNORECASE)
_INCHES = {"px": 1 / 96, "pt": 1 / 72, "pc": 1 / 6, "in": 1.0, "mm": 1 / 25.4, "cm": 1 / 2.54, "q": 1 / 101.6}
"""Units of lengths; without one it is px."""
_ROOT = re.compile(rb"""(<[^\s/>]+)((?:\s+[^\s=>/]+\s*=\s*(?:"[^"]*"|'[^']*'))*)(\s*/?>)""")
"""The root's start: its name, its attributes, its end."""
_SIDES = re.compile(rb"""\s(?:width|height)\s*=\s*(?:"[^"]*"|'[^']*')""")


@dataclass(frozen=True, slots=True)
class _Weight:
    """Number of elements that are drawn, and their depth of nesting."""

    parts: int
    depth: int


_ENDLESS = _Weight(MAX_PARTS + 1, 1)


def draw(data: bytes, key: str, width_m: float, *, seconds: float) -> tuple[bytes, float]:
    """Return an SVG as the PNG that resvg draws, with the resolution of the ground for `width_m`, and the time it took.

    Raises FieldError, with this key, for an SVG that is rejected or cannot be drawn within `seconds`.
    """
    try:
        root = xml_tree.parse(data)
    except XmlError as error:
        raise FieldError(f"{key} (SVG line {error.line})", error.found, error.expected) from error
    _check(root, key)
    size = _size(root, key)
    ratio = size[1] / size[0]
    columns = round(min(MAX_SIDE, max(1.0, width_m / PIXEL_M)))
    columns = max(1, math.floor(min(columns, MAX_SIDE / ratio, math.sqrt(MAX_PIXELS / ratio))))
    rows = max(1, round(columns * ratio))
    resvg = imported("resvg_py", "resvg-py", key)
    try:
        text = _resized(data.decode("utf-8"), root, size, columns, rows)
    except ValueError as error:
        raise FieldError(key, f"an SVG that cannot be drawn ({error})", "a complete SVG in UTF-8") from error
    try:
        return svg_process.draw(text, resvg, seconds=seconds)
    except DrawError as error:
        raise FieldError(key, error.found, error.expected) from error


def _check(root: Element, key: str) -> None:
    if root.tag != "svg":
        raise FieldError(key, f"<{root.tag}>", "<svg>")
    styles = _Styles(key)
    for element in root.walk():
        where = f"{key} (SVG line {element.line})"
        if element.tag in _REFUSED:
            raise FieldError(where, f"<{element.tag}>", _REFUSED[element.tag])
        for target in _targets(element):
            if not target.startswith("#"):
                raise FieldError(where, f"a reference to '{target[:40]}'", "references within the image")
        _check_style(element, styles, where)
    by_id: dict[str, list[Element]] = {}
    for element in root.walk():
        by_id.setdefault(element.attributes.get("id", ""), []).append(element)
    _weigh(root, by_id, styles, {}, key)


class _Styles:
    """The CSS of one image. Equal texts are parsed once: drawing programs repeat their styles on each element."""

    def __init__(self, key: str) -> None:
        self._key = key
        self._known: dict[str, Style] = {}
        self._size = 0

    def parse(self, text: str) -> Style:
        """Parse a text of CSS. Raises FieldError if all texts together are too long."""
        found = self._known.get(text)
        if found is None:
            self._size += len(text)
            if self._size > MAX_STYLES:
                raise FieldError(self._key, f"more than {MAX_STYLES} characters of CSS", "fewer or shorter styles")
            found = self._known[text] = css.parse(text, _EFFECTS)
        return found

    def urls(self, element: Element) -> Iterator[str]:
        """Iterate over the targets of every `url(…)` in the attributes of an element."""
        for name, value in element.attributes.items():
            if name == "style" or "\\" in value or "url" in value.lower():
                yield from self.parse(value).urls


def _check_style(element: Element, styles: _Styles, where: str) -> None:
    """Raise FieldError for effects of unlimited cost and external references in attributes or a style sheet."""
    for name, value in element.attributes.items():
        if name.startswith("svg:"):
            raise FieldError(where, f"the attribute {name} with a namespace", "attributes without a namespace")
        if name in _EFFECTS and value.strip().lower() not in _WITHOUT_EFFECT:
            raise FieldError(where, f'{name}="{value[:40]}"', _EFFECTS[name])
    for target in styles.urls(element):
        if not target.startswith("#"):
            raise FieldError(where, f"a reference to '{target[:40]}'", "references within the image")
    texts = [element.attributes["style"]] if "style" in element.attributes else []
    if element.tag == "style":
        texts.append(element.text)
        sheet = styles.parse(element.text)
        if "import" in sheet.rules:
            raise FieldError(where, "@import in <style>", "styles within the image")
        if sheet.urls:
            raise FieldError(where, "url(…) in <style>", "references in the attributes of elements")
    for text in texts:
        for declaration in styles.parse(text).declarations:
            if not (len(declaration.value) == 1 and declaration.value[0] in _WITHOUT_EFFECT):
                found = f"'{declaration.name}' in a style"
                raise FieldError(where, found, _EFFECTS[declaration.name])


def _weigh(
    element: Element,
    by_id: dict[str, list[Element]],
    styles: _Styles,
    known: dict[int, _Weight],
    key: str,
    above: int = 0,
) -> _Weight:
    """Return the cost of drawing an element with everything that it references.

    An element is drawn anew for each reference to it, and nested elements are in memory at the same time, so both the
    number and the depth could grow exponentially. Weights are computed once per element (`known`); an element that is
    being weighed counts as endless, which detects cycles of references. Raises FieldError above the limits.
    """
    if above > MAX_DEPTH:
        raise FieldError(key, f"elements nested more than {MAX_DEPTH} deep", "a simpler image")
    weight = known.get(id(element))
    if weight is None:
        known[id(element)] = _ENDLESS
        named = [other for name in _references(element, styles) if name for other in by_id.get(name, ())]
        inner = [_weigh(other, by_id, styles, known, key, above + 1) for other in (*element.children, *named)]
        weight = known[id(element)] = _Weight(
            1 + sum(one.parts for one in inner), 1 + max((one.depth for one in inner), default=0)
        )
    if weight.parts > MAX_PARTS:
        raise FieldError(key, f"more than {MAX_PARTS} elements to draw", "a simpler image")
    if above + weight.depth > MAX_DEPTH:
        raise FieldError(key, f"elements nested more than {MAX_DEPTH} deep", "a simpler image")
    return weight


def _references(element: Element, styles: _Styles) -> list[str]:
    """Return the ids of the elements that this one is drawn with."""
    found = [target[1:] for target in styles.urls(element)]
    if element.tag == "use":
        found += (target[1:] for target in _targets(element))
    return found


def _targets(element: Element) -> list[str]:
    """Return the references of an element; if it has both attributes, renderers differ in which one they use."""
    return [element.attributes[key] for key in _HREFS if key in element.attributes]


def _size(root: Element, key: str) -> tuple[float, float]:
    """Return width and height in px; from the view box if they are not given in absolute units."""
    width, height = (_pixels(root.attributes.get(side, "")) for side in ("width", "height"))
    box = re.split(r"[\s,]+", root.attributes.get("viewBox", "").strip())
    across, down = map(_pixels, box[2:]) if len(box) == 4 else (math.nan, math.nan)
    ratio = down / across if across > 0.0 else math.nan
    if math.isnan(width):
        width = across if math.isnan(height) or not ratio > 0.0 else height / ratio
    if math.isnan(height):
        height = width * ratio
    ratio = height / width if width > 0.0 else math.nan
    if not (math.isfinite(ratio) and ratio > 0.0):
        raise FieldError(key, "an SVG without a size", "viewBox, or width and height, in <svg>")
    if not 0.01 <= ratio <= 100:
        raise FieldError(key, f"{width:g} x {height:g} px", "an aspect ratio of at most 100 to 1")
    return width, height


def _pixels(length: str) -> float:
    """Return an absolute length in px; NaN for anything else."""
    match = _LENGTH.fullmatch(length)
    try:
        return math.nan if match is None else float(match[1]) * CSS_DPI * _INCHES[(match[2] or "px").lower()]
    except ValueError:  # 1.2.3
        return math.nan


def _resized(text: str, root: Element, size: tuple[float, float], columns: int, rows: int) -> str:
    """Return the SVG with its size set to this number of pixels: resvg rounds a size up before it scales."""
    data = text.encode("utf-8")
    match = _ROOT.match(data, root.offset)
    if match is None:
        raise ValueError("its root element was not found")
    attributes = _SIDES.sub(b"", match[2]) + f' width="{columns}" height="{rows}"'.encode()
    if "viewBox" not in root.attributes:
        attributes += f' viewBox="0 0 {size[0]!r} {size[1]!r}"'.encode()
    changed = data[: match.start()] + match[1] + attributes + match[3] + data[match.end() :]
    return changed.decode("utf-8")
