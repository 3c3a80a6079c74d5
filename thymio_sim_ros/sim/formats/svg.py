"""SVG images as pixels, drawn by resvg, without what has no limited cost or depends on the machine.

Not drawn are text (fonts, and with them readings, differ between machines), images and external references, and
filters, masks, blend modes and markers (their cost has no limit), be it as elements, attributes or CSS. An element that
is one of them or has one of them is skipped, with a note; a shape with markers is drawn without them. References are
followed wherever they are: in attributes, in styles and in style sheets, whose rules count for at least the elements
that they select (`css`). Everything else is limited by the drawing process (`svg_process`).
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from thymio_sim_ros.sim.formats import css, svg_process, xml_tree
from thymio_sim_ros.sim.formats.css import Sheet, Style
from thymio_sim_ros.sim.formats.svg_process import DrawError
from thymio_sim_ros.sim.formats.svg_worker import CSS_DPI
from thymio_sim_ros.sim.formats.xml_tree import Element, XmlError
from thymio_sim_ros.sim.model.fields import FieldError
from thymio_sim_ros.sim.model.optional_import import imported

__all__ = ["Drawing", "draw"]

PIXEL_M = 0.001
"""Size of a pixel of a drawn SVG in m, that of the ground; edges are anti-aliased."""
MAX_SIDE = 4096
MAX_PIXELS = 6_000_000
MAX_PARTS = 20_000
"""Largest number of elements that are drawn, repeated ones counted each time."""
MAX_DEPTH = 40
"""Largest depth of nested elements, references included; each may need a buffer while it is drawn."""

_NO_IMAGES = "shapes and paths, or a PNG instead of the SVG"
_NO_MASKS = "no masks (clip paths are allowed)"
_NO_MARKERS = "no markers (convert them to paths)"
_SKIPPED = {
    "text": "paths (in Inkscape: Path > Object to Path)",
    "image": _NO_IMAGES,
    "foreignObject": "shapes and paths",
    "script": "no scripts",
    "animate": "no animation",
    "animateMotion": "no animation",
    "animateTransform": "no animation",
    "set": "no animation",
}
"""Elements that are not drawn, and what to use."""
_DEFINITIONS = frozenset({"filter", "mask", "marker"})
"""Elements that are drawn only where another one names them; that one has the note."""
_EFFECTS = {
    "filter": "no filters",
    "backdrop-filter": "no filters",
    "mask": _NO_MASKS,
    "mask-image": _NO_MASKS,
    "mask-border": _NO_MASKS,
    "mask-border-source": _NO_MASKS,
    "mask-box-image": _NO_MASKS,
    "mix-blend-mode": "no blend modes",
    "marker": _NO_MARKERS,
    "marker-start": _NO_MARKERS,
    "marker-mid": _NO_MARKERS,
    "marker-end": _NO_MARKERS,
}
"""Properties of elements that are not drawn, as attributes and in CSS, except with a value of `_WITHOUT_EFFECT`."""
_WITHOUT_EFFECT = frozenset({"none", "auto", "normal", "initial", "unset"})
"""Inkscape writes `filter:none;mix-blend-mode:normal` into every style."""
MAX_STYLES = 300_000
"""Largest number of characters of CSS, equal styles counted once."""
MAX_SELECTIONS = 1_000_000
"""Largest number of comparisons of a selector of a style sheet with an element."""
MAX_LINES = 5
"""Number of lines that a note names."""
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


@dataclass(frozen=True, slots=True)
class Drawing:
    """A drawn SVG: the file in PNG, the processor time it took in s, and a note for each kind of what is missing."""

    png: bytes
    seconds: float
    notes: tuple[str, ...]


def draw(data: bytes, key: str, width_m: float, *, seconds: float) -> Drawing:
    """An SVG as resvg draws it, with the resolution of the ground for `width_m`.

    Raises FieldError, with this key, for an SVG that is rejected or cannot be drawn within `seconds`.
    """
    try:
        text, _ = xml_tree.text_of(data)
        root = xml_tree.parse(text)
    except XmlError as error:
        raise FieldError(f"{key} (SVG line {error.line})", error.found, error.expected) from error
    if root.tag != "svg":
        raise FieldError(key, f"<{root.tag}>", "<svg>")
    pruned = _Pruned(root, key)
    _weigh(root, pruned.by_id(), pruned.references, {}, key)
    size = _size(root, key)
    ratio = size[1] / size[0]
    columns = round(min(MAX_SIDE, max(1.0, width_m / PIXEL_M)))
    columns = max(1, math.floor(min(columns, MAX_SIDE / ratio, math.sqrt(MAX_PIXELS / ratio))))
    rows = max(1, round(columns * ratio))
    resvg = imported("resvg_py", "resvg-py", key)
    try:
        text = _resized(pruned.cut(text.encode("utf-8")), root, size, columns, rows)
    except ValueError as error:
        raise FieldError(key, f"an SVG that cannot be drawn ({error})", "a complete SVG") from error
    try:
        png, seconds_used = svg_process.draw(text, resvg, seconds=seconds)
    except DrawError as error:
        raise FieldError(key, error.found, error.expected) from error
    return Drawing(png, seconds_used, pruned.notes())


class _Pruned:
    """An SVG without what is not drawn.

    Attributes:
        references: id of the Python object of an element → the ids that it is drawn with.
    """

    def __init__(self, root: Element, key: str) -> None:
        self._root = root
        self._key = key
        self._styles = _Styles(key)
        self._sheet = Sheet()
        self._cut: list[Element] = []
        self._lines: dict[tuple[str, str], list[int]] = {}
        """Lines of each remark; the key is the pair of found and expected text."""
        self.references: dict[int, list[str]] = {}
        for element in root.walk():
            if element.tag == "style":
                self._read_sheet(element)
        self._prune(root)

    def by_id(self) -> dict[str, list[Element]]:
        """The drawn elements by id."""
        found: dict[str, list[Element]] = {}
        for element in self._root.walk():
            found.setdefault(element.attributes.get("id", ""), []).append(element)
        return found

    def cut(self, data: bytes) -> bytes:
        """The text in UTF-8 without the skipped elements."""
        pieces, begin = [], 0
        for element in self._cut:
            pieces.append(data[begin : element.offset])
            begin = element.end
        return b"".join((*pieces, data[begin:]))

    def notes(self) -> tuple[str, ...]:
        """Notes on the parts that the drawing lacks, one for each kind."""
        return tuple(self._note(*kind, lines) for kind, lines in self._lines.items())

    def _note(self, found: str, expected: str, lines: list[int]) -> str:
        lines = list(dict.fromkeys(lines))
        named = ", ".join(map(str, lines[:MAX_LINES]))
        more = f" and {len(lines) - MAX_LINES} more" if len(lines) > MAX_LINES else ""
        place = f"SVG line{'s' if len(lines) > 1 else ''} {named}{more}"
        return f"{self._key} ({place}): {found} skipped, expected {expected}"

    def _read_sheet(self, element: Element) -> None:
        if "import" in self._styles.parse(element.text).rules:
            self._remark(element, "@import in <style>", "styles within the image")
        self._sheet.add(element.text, _EFFECTS)

    def _remark(self, element: Element, found: str, expected: str) -> None:
        self._lines.setdefault((found, expected), []).append(element.line)

    def _prune(self, root: Element) -> None:
        """Take skipped elements out of the tree, in the order of the text, and note the references of the others."""
        waiting: list[tuple[Element, css.Path]] = [(root, ((root.tag, root.attributes),))]
        while waiting:
            element, path = waiting.pop()
            if self._is_skipped(element, path):
                if element is root:
                    ((found, expected), _) = self._lines.popitem()
                    raise FieldError(f"{self._key} (SVG line {root.line})", found, expected)
                self._cut.append(element)
                element.tag, element.children = "", []
            else:
                waiting.extend((child, (*path, (child.tag, child.attributes))) for child in reversed(element.children))
        for element in root.walk():
            element.children = [child for child in element.children if child.tag]

    def _is_skipped(self, element: Element, path: css.Path) -> bool:
        """Whether an element is not drawn; if something would be missing, there is a note."""
        if element.tag in _DEFINITIONS:
            return True
        if element.tag in _SKIPPED:
            self._remark(element, f"<{element.tag}>", _SKIPPED[element.tag])
            return True
        for name in element.attributes:
            if name.startswith("svg:"):
                self._remark(element, f"the attribute {name} with a namespace", "attributes without a namespace")
                return True
        styles = self._sheet.styles(path)
        if self._sheet.checks > MAX_SELECTIONS:
            raise FieldError(self._key, "style sheets with too many rules for its elements", "a simpler image")
        targets = [*self._styles.urls(element), *(target for style in styles for target in style.urls)]
        named = _targets(element)
        for target in (*named, *targets):
            if not target.startswith("#"):
                self._remark(element, f"a reference to '{target[:40]}'", "references within the image")
                return True
        if any(self._has_effect(element, *effect) for effect in self._effects(element, styles)):
            return True
        found = [target[1:] for target in targets]
        if element.tag == "use":
            found += (target[1:] for target in named)
        self.references[id(element)] = found
        return False

    def _effects(self, element: Element, styles: Sequence[Style]) -> Iterator[tuple[str, str]]:
        """Name and text of each property of `_EFFECTS` that an element may have."""
        for name, value in element.attributes.items():
            if name in _EFFECTS and value.strip().lower() not in _WITHOUT_EFFECT:
                yield name, f'{name}="{value[:40]}"'
        own = (self._styles.parse(element.attributes["style"]),) if "style" in element.attributes else ()
        for style in (*own, *styles):
            for declaration in style.declarations:
                if not (len(declaration.value) == 1 and declaration.value[0] in _WITHOUT_EFFECT):
                    yield declaration.name, f"'{declaration.name}' in a style"

    def _has_effect(self, element: Element, name: str, found: str) -> bool:
        """Note an effect; return whether the element cannot be drawn without it."""
        expected = _EFFECTS[name]
        is_needed = expected is not _NO_MARKERS
        self._remark(element, f"<{element.tag}> with {found}" if is_needed else found, expected)
        return is_needed


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
        """The targets of every `url(…)` in the attributes of an element."""
        for name, value in element.attributes.items():
            if name == "style" or "\\" in value or "url" in value.lower():
                yield from self.parse(value).urls


def _weigh(
    element: Element,
    by_id: dict[str, list[Element]],
    references: dict[int, list[str]],
    known: dict[int, _Weight],
    key: str,
    above: int = 0,
) -> _Weight:
    """The cost of drawing an element with everything that it references.

    An element is drawn anew for each reference to it, and nested elements are in memory at the same time, so both the
    number and the depth could grow exponentially. Weights are computed once per element (`known`); an element that is
    being weighed counts as endless, which detects cycles of references. Raises FieldError above the limits.
    """
    if above > MAX_DEPTH:
        raise FieldError(key, f"elements nested more than {MAX_DEPTH} deep", "a simpler image")
    weight = known.get(id(element))
    if weight is None:
        known[id(element)] = _ENDLESS
        named = [other for name in references[id(element)] if name for other in by_id.get(name, ())]
        inner = [_weigh(other, by_id, references, known, key, above + 1) for other in (*element.children, *named)]
        weight = known[id(element)] = _Weight(
            1 + sum(below.parts for below in inner), 1 + max((below.depth for below in inner), default=0)
        )
    if weight.parts > MAX_PARTS:
        raise FieldError(key, f"more than {MAX_PARTS} elements to draw", "a simpler image")
    if above + weight.depth > MAX_DEPTH:
        raise FieldError(key, f"elements nested more than {MAX_DEPTH} deep", "a simpler image")
    return weight


def _targets(element: Element) -> list[str]:
    """The references of an element; if it has both attributes, renderers differ in which one they use."""
    return [element.attributes[key] for key in _HREFS if key in element.attributes]


def _size(root: Element, key: str) -> tuple[float, float]:
    """Width and height in px; from the view box if they are not given in absolute units."""
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
    """An absolute length in px; NaN for anything else."""
    match = _LENGTH.fullmatch(length)
    try:
        return math.nan if match is None else float(match[1]) * CSS_DPI * _INCHES[(match[2] or "px").lower()]
    except ValueError:  # 1.2.3
        return math.nan


def _resized(data: bytes, root: Element, size: tuple[float, float], columns: int, rows: int) -> str:
    """The SVG with its size set to this number of pixels: resvg rounds a size up before it scales."""
    match = _ROOT.match(data, root.offset)
    if match is None:
        raise ValueError("its root element was not found")
    attributes = _SIDES.sub(b"", match[2]) + f' width="{columns}" height="{rows}"'.encode()
    if "viewBox" not in root.attributes:
        attributes += f' viewBox="0 0 {size[0]!r} {size[1]!r}"'.encode()
    changed = data[: match.start()] + match[1] + attributes + match[3] + data[match.end() :]
    return changed.decode("utf-8")
