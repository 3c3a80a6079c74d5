"""Ground pictures: what is decoded, and what is refused before it is unpacked."""

from __future__ import annotations

import io
import struct
import sys
import zlib

import pytest

from tests.sim.images import BLACK, CLEAR, RED, WHITE, pixels, png, png_uri, svg_uri
from thymio_sim_ros.sim.formats import image_io
from thymio_sim_ros.sim.formats.image_io import MAX_PICTURE_BYTES, Pixels, data_uri
from thymio_sim_ros.sim.formats.svg import Drawing
from thymio_sim_ros.sim.model.fields import FieldError

image = pytest.importorskip("PIL.Image")


def decode(uri: str, width_m: float = 0.1) -> Pixels:
    """As a playground of its own, on a machine that may be busy."""
    with image_io.budgeted() as budget:
        budget.svg_seconds = 60.0
        return image_io.decode(uri, key="image", width_m=width_m)


def refused(uri: str) -> FieldError:
    with pytest.raises(FieldError) as caught:
        image_io.decode(uri, key="image", width_m=0.1)
    return caught.value


def color_at(found: Pixels, column: int, row: int) -> tuple[int, ...]:
    start = 4 * (row * found.columns + column)
    return tuple(found.rgba[start : start + 4])


def chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png_of_size(columns: int, rows: int) -> bytes:
    header = struct.pack(">IIBBBBB", columns, rows, 8, 2, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", header)
        + chunk(b"IDAT", zlib.compress(b"\0" * 1000))
        + chunk(b"IEND", b"")
    )


def test_a_png_comes_back_pixel_by_pixel() -> None:
    rows = [[WHITE, BLACK, RED], [CLEAR, (1, 2, 3, 4), WHITE]]
    assert decode(png_uri(rows)) == pixels(rows)


@pytest.mark.parametrize(("mode", "value"), [("L", 128), ("I;16", 128 * 257), ("1", 1), ("P", 0)])
def test_pngs_of_other_kinds_become_colors(mode: str, value: int) -> None:
    out = io.BytesIO()
    image.new(mode, (2, 2), value).save(out, "PNG")
    gray = {"1": 255, "P": 0}.get(mode, 128)
    assert color_at(decode(data_uri(out.getvalue(), "image/png")), 1, 1) == (gray, gray, gray, 255)


def test_a_jpeg_is_read() -> None:
    out = io.BytesIO()
    image.new("RGB", (8, 8), (255, 255, 255)).save(out, "JPEG")
    assert color_at(decode(data_uri(out.getvalue(), "image/jpeg")), 3, 3) == WHITE


def test_an_svg_is_drawn_a_pixel_for_each_millimetre() -> None:
    pytest.importorskip("resvg_py")
    found = decode(svg_uri('<rect width="50" height="50" fill="#808080"/>'), 0.2)
    assert (found.columns, found.rows) == (200, 100)
    assert color_at(found, 50, 50) == (128, 128, 128, 255)
    assert color_at(found, 150, 50)[3] == 0


@pytest.mark.parametrize(
    "attributes",
    [
        'width="20mm" height="10mm" viewBox="-5 -5 10 5"',
        'width="200" height="100"',
        'width="100%" viewBox="0,0,2,1"',
        'width="2cm" height="10mm"',
        'width="1in" height="48"',
        'width="1pc" height="6pt"',
        'width="80Q" height="10mm"',
        'width="0.4px" height="0.2"',
        'height="10mm" viewBox="0 0 40 20"',
        'width="50%" height="1em" viewBox="0 0 4 2"',
        'viewBox="0 0 1 0.5"',
    ],
)
def test_the_size_of_an_svg_may_be_written_in_many_ways(attributes: str) -> None:
    pytest.importorskip("resvg_py")
    found = decode(svg_uri('<rect x="-500" y="-500" width="1000" height="1000"/>', attributes), 0.2)
    assert (found.columns, found.rows, color_at(found, 100, 50)) == (200, 100, BLACK)


def drawn(body: str, attributes: str = 'viewBox="0 0 100 50"') -> tuple[Pixels, list[str]]:
    """An SVG as it is drawn, and what is missing in it."""
    pytest.importorskip("resvg_py")
    with image_io.budgeted() as budget:
        budget.svg_seconds = 60.0
        return image_io.decode(svg_uri(body, attributes), key="image", width_m=0.1), budget.notes


RECT = '<rect x="50" width="50" height="50"/>'
"""The right half."""
WHOLE = 'width="100" height="50"'


@pytest.mark.parametrize(
    ("body", "found"),
    [
        ("<text>Hello</text>", "<text>"),
        ("<switch><foreignObject><p/></foreignObject></switch>", "<foreignObject>"),
        ('<g><image href="/etc/hostname" width="10" height="10"/></g>', "<image>"),
        ('<use xlink:href="other.svg#a"/>', "a reference to 'other.svg#a'"),
        ('<use href="#a" xlink:href="other.svg#a"/>', "a reference to 'other.svg#a'"),
        ('<use xmlns:x="http://www.w3.org/1999/xlink" x:href="other.svg#a"/>', "a reference to 'other.svg#a'"),
        ("<script>alert(1)</script>", "<script>"),
        (f'<rect fill="url(other.svg#a)" {WHOLE}/>', "a reference to 'other.svg#a'"),
        (f'<rect style="fill:u\\72l( other.svg )" {WHOLE}/>', "a reference to 'other.svg'"),
        (f'<style>.a {{ fill: url(other.svg#a) }}</style><g class="b a"><rect {WHOLE}/></g>', "other.svg#a"),
        ("<style>@import 'other.css';</style>", "@import in <style>"),
        ("<style>a{}@\\69mport 'other.css';</style>", "@import in <style>"),
        (f'<g xmlns:s="http://www.w3.org/2000/svg" s:style="filter:blur(9px)"><rect {WHOLE}/></g>', "svg:style"),
    ],
)
def test_what_depends_on_something_else_costs_its_element_and_a_note(body: str, found: str) -> None:
    picture, notes = drawn(body + RECT)
    assert (color_at(picture, 25, 25), color_at(picture, 75, 25)) == (CLEAR, BLACK)
    assert len(notes) == 1
    assert notes[0].startswith("image (SVG line 1): ")
    assert found in notes[0]
    assert "skipped, expected " in notes[0]


EFFECTS = ("filter", "mask", "mix-blend-mode")


@pytest.mark.parametrize("effect", EFFECTS)
@pytest.mark.parametrize(
    "body",
    [
        '<g style="{0}:x">{3}</g>',
        '<g style="fill:red; {1} : x">{3}</g>',
        '<g style="{0}/* */:x !important">{3}</g>',
        '<g style="{2}:x">{3}</g>',
        "<style>g {{ {0}: x }}</style><g>{3}</g>",
        '<g class="st0">{3}</g><style type="text/css">.st0{{{0}:x;}} .st1{{fill:none}}</style>',
        '<style>svg > .a .b, #c:hover {{ {0}: x }}</style><g class="a"><g class="c b">{3}</g></g>',
        "<style><![CDATA[@media all {{ g {{ fill: red; {1}/**/:x }} }}]]></style><g>{3}</g>",
    ],
)
def test_an_effect_in_css_costs_its_element_and_a_note(effect: str, body: str) -> None:
    escaped = f"\\{ord(effect[0]):x} {effect[1:]}"
    picture, notes = drawn(body.format(effect, effect.upper(), escaped, f"<rect {WHOLE}/>") + RECT)
    assert (color_at(picture, 25, 25), color_at(picture, 75, 25)) == (CLEAR, BLACK)
    assert [note.partition(" skipped")[0] for note in notes] == [f"image (SVG line 1): <g> with '{effect}' in a style"]


@pytest.mark.parametrize("effect", EFFECTS)
def test_an_effect_as_an_attribute_costs_its_element_and_a_note(effect: str) -> None:
    picture, notes = drawn(f'<g {effect}="x"><rect {WHOLE}/></g>{RECT}')
    assert (color_at(picture, 25, 25), color_at(picture, 75, 25)) == (CLEAR, BLACK)
    assert notes[0].startswith(f'image (SVG line 1): <g> with {effect}="x" skipped, expected no ')


def test_a_rule_costs_only_the_elements_that_it_selects() -> None:
    sheet = "<style>.a .b, .c>rect, #d.e, circle { filter: url(#f) }</style>"
    body = (
        f'{sheet}<g class="b"><rect class="a" {WHOLE}/></g><g class="c"><g>{RECT}</g></g><rect id="d"/><g class="e"/>'
    )
    picture, notes = drawn(body)
    assert (color_at(picture, 25, 25), notes) == (BLACK, [])


def test_shapes_are_drawn_without_their_markers() -> None:
    markers = '<defs><marker id="m"><rect width="9" height="9"/></marker></defs><style>.a{marker-end:url(#m)}</style>'
    picture, notes = drawn(f'{markers}<rect class="a" {WHOLE}/><path marker-start="url(#m)" d="M0 0L9 9"/>')
    assert color_at(picture, 25, 25) == BLACK
    assert len(notes) == 2
    assert all("skipped, expected no markers" in note for note in notes)


def test_definitions_of_effects_that_nothing_uses_are_no_loss() -> None:
    unused = '<mask id="m"><rect/></mask><filter id="f"><feTurbulence numOctaves="9999999"/></filter>'
    assert drawn(f"<defs>{unused}</defs><rect {WHOLE}/>")[1] == []


def test_equal_losses_are_one_note() -> None:
    text = "<text>A</text>\n" * 9
    assert drawn(text)[1] == [
        "image (SVG lines 1, 2, 3, 4, 5 and 4 more): <text> skipped, "
        "expected paths (in Inkscape: Path > Object to Path)"
    ]


def test_isolated_groups_are_drawn_as_illustrator_writes_them() -> None:
    sheet = "<style>.cls-1 { isolation: isolate; }</style>"
    picture, notes = drawn(f'{sheet}<g class="cls-1"><rect {WHOLE}/></g>')
    assert (color_at(picture, 25, 25), notes) == (BLACK, [])


@pytest.mark.parametrize(
    "sheet",
    [
        ".a{clip-path:url(#c);fill:#000}",
        ".st0, .a { clip-path : url('#c') }",
        "rect.a{clip-path:url( #c )}",
        "#r{clip-path:url(#c)}",
        "svg>rect{clip-path:url(#c)}",
        "*[class]{clip-path:url(#c)}",
        "[id='r']{clip-path:url(#c)}",
        "svg .a{clip-path:url(#c)!important}",
    ],
)
def test_a_reference_in_a_style_sheet_is_that_of_an_attribute(sheet: str) -> None:
    clip = '<defs><clipPath id="c"><rect width="50" height="50"/></clipPath></defs>'
    picture, notes = drawn(f'<style>{sheet}</style>{clip}<rect id="r" class="a" {WHOLE}/>')
    assert (color_at(picture, 25, 25), color_at(picture, 75, 25), notes) == (BLACK, CLEAR, [])


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "iso-8859-1", "windows-1252"])
def test_an_svg_may_have_any_encoding(encoding: str) -> None:
    pytest.importorskip("resvg_py")
    declared = encoding.removesuffix("-sig")
    text = f'<?xml version="1.0" encoding="{declared}"?><svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 2 1">'
    text += '<title>Zoë</title><rect width="1" height="1"/></svg>'
    found = decode(data_uri(text.encode(encoding), "image/svg+xml"))
    assert (color_at(found, 25, 25), color_at(found, 75, 25)) == (BLACK, CLEAR)


def test_effects_that_are_none_are_drawn_as_drawing_programs_write_them() -> None:
    pytest.importorskip("resvg_py")
    style = "fill:#808080;mix-blend-mode:normal;isolation:auto;filter:none;marker:none;mask:none !important"
    found = decode(svg_uri(f'<rect width="100" height="50" style="{style}" filter="none"/>'))
    assert color_at(found, 5, 5) == (128, 128, 128, 255)


def test_equal_styles_are_parsed_once_and_others_are_limited() -> None:
    style = "fill:#80" + "8" * 200
    assert "characters of CSS" in refused(svg_uri("".join(f'<g style="{style}{n}"/>' for n in range(1500)))).found
    pytest.importorskip("resvg_py")
    assert decode(svg_uri(f'<g style="{style}"/>' * 1500)).columns == 100


DOUBLING = {
    "use": ('<g id="g{n}"><use href="#g{m}"/><use href="#g{m}"/></g>', '<rect id="g0" width="1" height="1"/>'),
    "pattern": (
        '<pattern id="g{n}" width="1" height="1"><rect fill="url(#g{m})" width="1" height="1"/>'
        '<rect fill="url(#g{m})" width="1" height="1"/></pattern>',
        '<pattern id="g0" width="1" height="1"/>',
    ),
    "clipPath": ('<clipPath id="g{n}" clip-path="url(#g{m})"><use href="#g{m}"/></clipPath>', '<clipPath id="g0"/>'),
}


@pytest.mark.parametrize("kind", DOUBLING)
def test_an_svg_that_repeats_itself_without_end_is_refused(kind: str) -> None:
    step, start = DOUBLING[kind]
    steps = "".join(step.format(n=n + 1, m=n) for n in range(30))
    assert "elements to draw" in refused(svg_uri(start + steps + '<rect fill="url(#g30)"/>')).found


@pytest.mark.parametrize(
    "body",
    [
        "<g opacity='0.9'>" * 60 + "</g>" * 60,
        '<rect id="g0"/>' + "".join(f'<g id="g{n + 1}"><use href="#g{n}"/></g>' for n in range(3000)),
        "".join(f'<g id="g{n}"><use href="#g{n + 1}"/></g>' for n in range(3000)) + '<rect id="g3000"/>',
    ],
)
def test_an_svg_that_is_too_deep_is_refused(body: str) -> None:
    assert refused(svg_uri(body)).found == "elements nested more than 40 deep"


@pytest.mark.parametrize(
    "disguise",
    ['xlink:href="#g{m}" y:href="#tiny"', 'href="#g{m}" xlink:href="#tiny"', 'href="#tiny" xlink:href="#g{m}"'],
)
def test_an_svg_that_repeats_itself_in_disguise_is_refused(disguise: str) -> None:
    step = '<g id="g{n}" y:id="x">' + f"<use {disguise}/>" * 2 + "</g>"
    steps = "".join(step.format(n=n + 1, m=n) for n in range(30))
    body = '<rect id="g0" width="1" height="1"/><rect id="tiny"/>' + steps
    assert "elements to draw" in refused(svg_uri(body, 'viewBox="0 0 1 1" xmlns:y="urn:y"')).found


def test_a_photo_of_a_camera_held_upright_stands_upright() -> None:
    out, tags = io.BytesIO(), image.Exif()
    tags[0x0112] = 6  # the top is at the right
    image.new("RGB", (40, 20), (255, 255, 255)).save(out, "JPEG", exif=tags)
    found = decode(data_uri(out.getvalue(), "image/jpeg"))
    assert (found.columns, found.rows) == (20, 40)


def test_a_circle_of_references_is_refused() -> None:
    body = '<g id="a"><use href="#b"/></g><g id="b"><use href="#a"/></g><rect width="9" height="9"/>'
    assert "elements to draw" in refused(svg_uri(body)).found


def test_an_svg_that_repeats_itself_by_its_style_sheet_is_refused() -> None:
    step = '<pattern id="g{n}" width="1" height="1">' + '<rect class="a{m}" width="1" height="1"/>' * 2 + "</pattern>"
    steps = "".join(step.format(n=n + 1, m=n) for n in range(30))
    sheet = "".join(f".a{n}{{fill:url(#g{n})}}" for n in range(31))
    assert "elements to draw" in refused(svg_uri(f'<style>{sheet}</style>{steps}<rect class="a30"/>')).found


def test_style_sheets_with_too_many_rules_for_their_elements_are_refused() -> None:
    sheet = "*{fill:url(#a)}" * 2000
    assert "too many rules" in refused(svg_uri(f"<style>{sheet}</style>" + "<g/>" * 600)).found


def test_an_svg_of_a_large_ground_is_drawn_coarser() -> None:
    pytest.importorskip("resvg_py")
    found = decode(svg_uri("<rect/>", 'viewBox="0 0 100 100"'), 50.0)
    assert found.columns * found.rows <= 6_000_000


@pytest.mark.parametrize("attributes", ["", 'viewBox="0 0 1 100000"', 'width="10" height="0"', 'viewBox="0 0 a b"'])
def test_an_svg_without_a_sensible_size_is_refused(attributes: str) -> None:
    assert refused(svg_uri("<rect/>", attributes)).key == "image"


def test_entities_in_an_svg_are_refused() -> None:
    text = '<!DOCTYPE svg [<!ENTITY a "aaaaaaaa"><!ENTITY b "&a;&a;">]><svg viewBox="0 0 1 1">&b;</svg>'
    assert "entity 'a'" in refused(data_uri(text.encode(), "image/svg+xml")).found


def test_an_svg_of_illustrator_with_entities_is_drawn() -> None:
    start = '<!DOCTYPE svg [\n<!ENTITY ns_svg "http://www.w3.org/2000/svg">\n<!ENTITY black "#000000">\n]>'
    text = f'{start}<svg xmlns="&ns_svg;" viewBox="0 0 1 1"><text/><rect width="1" height="1" fill="&black;"/></svg>'
    plain = (
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1 1"><rect width="1" height="1" fill="#000000"/></svg>'
    )
    both = [decode(data_uri(each.encode(), "image/svg+xml")) for each in (text, plain)]
    assert color_at(both[0], 5, 5) == color_at(both[1], 5, 5) == BLACK


@pytest.mark.parametrize(
    "uri",
    [
        "data:image/gif;base64,R0lGODlhAQABAAAAACw=",
        "data:image/png,plain",
        "data:image/png;base64,###",
        data_uri(b"no picture", "image/png"),
        data_uri(png([[WHITE]])[:40], "image/png"),
        data_uri(b"<svg", "image/svg+xml"),
        data_uri(b"\xff\xfe<", "image/svg+xml"),
        data_uri(b"<html/>", "image/svg+xml"),
        data_uri(b"\0" * (MAX_PICTURE_BYTES + 1), "image/png"),
        "data:",
    ],
)
def test_anything_but_an_image_is_refused_with_its_key(uri: str) -> None:
    assert refused(uri).key.startswith("image")


@pytest.mark.parametrize("side", [8193, 60_000, 2**31 - 1])
def test_an_image_of_too_many_pixels_is_refused_before_it_is_unpacked(side: int) -> None:
    assert "pixels" in refused(data_uri(png_of_size(side, side), "image/png")).found


def test_an_image_for_display_may_be_scaled_down() -> None:
    rows = [[WHITE] * 100] * 40
    smaller = decode(data_uri(image_io.encode_png(pixels(rows), most=50), "image/png"))
    assert (smaller.columns, smaller.rows) == (50, 20)


@pytest.mark.parametrize(
    ("module", "package", "uri"),
    [("resvg_py", "resvg-py", svg_uri("<rect/>")), ("PIL.Image", "Pillow", png_uri([[WHITE]]))],
)
def test_without_its_package_an_image_is_refused_with_the_remedy(
    monkeypatch: pytest.MonkeyPatch, module: str, package: str, uri: str
) -> None:
    monkeypatch.setitem(sys.modules, module, None)
    error = refused(uri)
    assert (error.key, error.expected) == ("image", f"`pip install {package}`")


def test_an_svg_that_takes_too_long_is_refused() -> None:
    pytest.importorskip("resvg_py")
    body = '<g opacity=".5"><rect width="100" height="50"/></g>' * 5000  # a second and more on any machine
    with image_io.budgeted() as budget:
        budget.svg_seconds = 0.2
        assert "longer than 2 s" in refused(svg_uri(body)).found


def test_the_images_of_a_playground_share_the_time_to_draw(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(image_io.svg, "draw", lambda *_, seconds: Drawing(png([[WHITE]]), seconds / 2 + 0.6, ()))
    with image_io.budgeted() as budget:
        for _ in range(2):
            image_io.decode(svg_uri("<rect/>"), key="image", width_m=0.1)
    assert budget.svg_seconds == pytest.approx(2.0 - 1.6 - 0.8)


def test_the_images_of_a_playground_share_a_budget_of_pixels() -> None:
    picture = data_uri(png_of_size(5000, 4000), "image/png")
    with image_io.budgeted() as budget:
        budget.pixels = 19_000_000
        error = refused(picture)
        assert error.found == "5000 x 4000 pixels, with 19000000 of 32000000 left for images of this playground"
        assert budget.pixels == 19_000_000
        image_io.decode(png_uri([[WHITE] * 3] * 2), key="image", width_m=0.1)
    assert budget.pixels == 19_000_000 - 6


def test_the_svg_texts_of_a_playground_have_a_limit() -> None:
    with image_io.budgeted() as budget:
        budget.svg_bytes = 100
        assert "bytes of SVG" in refused(svg_uri("<rect/>")).found


def test_a_jpeg_that_is_painted_over_and_over_is_refused() -> None:
    out = io.BytesIO()
    image.new("RGB", (64, 64), (255, 255, 255)).save(out, "JPEG", progressive=True)
    data = out.getvalue()
    assert decode(data_uri(data, "image/jpeg")).columns == 64
    scan = data[data.rindex(b"\xff\xda") : -2]
    assert "scans" in refused(data_uri(data[:-2] + scan * 40 + data[-2:], "image/jpeg")).found


@pytest.mark.parametrize("mode", ["1", "L", "LA", "P", "RGB", "RGBA", "I;16"])
def test_bands_give_the_same_pixels_as_the_whole_image(mode: str, monkeypatch: pytest.MonkeyPatch) -> None:
    source = image.effect_noise((70, 50), 80).convert("RGB")
    if mode == "I;16":
        whole = image.frombytes("I;16", (70, 50), bytes(n % 251 for n in range(7000)))
    else:
        whole = source.quantize(17) if mode == "P" else source.convert(mode)
    out = io.BytesIO()
    whole.save(out, "PNG", **({"transparency": 3} if mode == "P" else {}))
    uri = data_uri(out.getvalue(), "image/png")
    at_once = decode(uri)
    monkeypatch.setattr(image_io, "_BAND_PIXELS", 70 * 7)
    assert decode(uri) == at_once
    if mode != "I;16":
        assert at_once.rgba == image.open(io.BytesIO(out.getvalue())).convert("RGBA").tobytes()
