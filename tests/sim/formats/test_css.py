"""CSS in pictures: declarations and references are found however they are written, and nowhere else."""

from __future__ import annotations

import pytest

from thymio_sim_ros.sim.formats import css
from thymio_sim_ros.sim.formats.css import Declaration, parse

WANTED = frozenset({"filter", "isolation"})


@pytest.mark.parametrize(
    "text",
    [
        "filter:blur(3px)",
        " FILTER : Blur(3px)",
        "fill:red;filter/* x */:/**/blur(3px)",
        "f\\69lter:blur(3px)",
        "\\66 ilter:blur(3px)",
        "\\000066ilter:blur(3px)",
        "-webkit-filter:blur(3px)",
        "filter:blur(3px)!important",
        "rect{filter:blur(3px)}",
        "@media all{rect{filter:blur(3px)}}",
        "a:';';filter:blur(3px)",
        "a:'\n;filter:blur(3px)",
        "<!-- rect{filter:blur(3px)} -->",
        "a{b:c;/*}*/filter:blur(3px)",
    ],
)
def test_a_declaration_is_found_however_it_is_written(text: str) -> None:
    assert parse(text, WANTED).declarations == (Declaration("filter", ("blur", "3px", ")")),)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "fill:red",
        "/* filter:blur(3px) */fill:red",
        "fill:'filter:blur(3px)'",
        "fil/**/ter:blur(3px)",
        "my-filter:blur(3px)",
        "filter",
        "filter;",
        "fill:url(filter:blur)",
        "fill:#filter",
    ],
)
def test_what_is_no_declaration_is_none(text: str) -> None:
    assert parse(text, WANTED).declarations == ()


@pytest.mark.parametrize("text", ["filter:none", "filter : NONE ! important;", "filter:none}", "filter:/* */n\\6fne"])
def test_a_value_is_compared_without_its_dress(text: str) -> None:
    assert parse(text, WANTED).declarations == (Declaration("filter", ("none",)),)


@pytest.mark.parametrize(
    "text",
    [
        "fill:url(#a)",
        "fill:URL( #a )",
        "fill:url('#a')",
        'fill:url( "#a" )',
        "fill:u\\72l(#a)",
        "fill:url(\\#a)",
        "fill:url(#\\61)",
        "fill:url(#a",
        "fill:url('#a",
    ],
)
def test_a_reference_is_found_however_it_is_written(text: str) -> None:
    assert parse(text, WANTED).urls == ("#a",)


@pytest.mark.parametrize("text", ["@import 'a.css';", "@IMPORT url(a.css)", "@\\69mport 'a.css'", "a{}@import/**/'a'"])
def test_rules_are_found(text: str) -> None:
    assert parse(text, WANTED).rules == ("import",)


@pytest.mark.parametrize("text", ["\\", "'\\", "a:\\", "url(", "url('", "/*", "@", "-", "\\110000 ", "\\0 ", "\\d800 "])
def test_text_that_ends_too_early_is_read_all_the_same(text: str) -> None:
    assert parse(text, WANTED).declarations == ()


ELEMENTS: dict[str, css.Path] = {
    "plain": (("svg", {}), ("rect", {})),
    "class": (("svg", {}), ("g", {"class": "top"}), ("rect", {"class": "a b", "id": "r"})),
    "deep": (("svg", {}), ("g", {"class": "top"}), ("g", {}), ("rect", {"class": "a"})),
}


@pytest.mark.parametrize(
    ("selector", "selected"),
    [
        ("*", {"plain", "class", "deep"}),
        ("rect", {"plain", "class", "deep"}),
        (".a", {"class", "deep"}),
        (".a.b", {"class"}),
        ("rect.b#r", {"class"}),
        (".top > .a", {"class"}),
        (".top .a", {"class", "deep"}),
        ("svg > g > g > rect", {"deep"}),
        ("g g .a, #r", {"class", "deep"}),
        ("[class='a b']", {"class"}),
        ("g > [ class ]", {"class", "deep"}),
        (".top > .b:first-child", {"class"}),
        (":is(.b, .c)", {"plain", "class", "deep"}),
        ("circle", set()),
        ("rect + .b", {"class"}),
        ("g::before rect", {"class", "deep"}),
    ],
)
def test_a_rule_counts_for_the_elements_that_it_may_select(selector: str, selected: set[str]) -> None:
    sheet = css.Sheet()
    sheet.add(f"@media all {{ {selector} {{ fill: red; filter: url(#f) }} }}", {"filter"})
    assert {name for name, path in ELEMENTS.items() if sheet.styles(path)} == selected


def test_references_of_fonts_are_those_of_no_element() -> None:
    assert css.rules("@font-face { src: url(a.woff) } @import url(b.css); .a { fill: red }", {"filter"}) == ()


def test_rules_within_rules_count() -> None:
    found = css.rules(".a { .b { fill: url(#x) } & > .c { fill: url(#y) } fill: url(#z)", {"filter"})
    assert [rule.style.urls for rule in found] == [("#x",), ("#y",), ("#z",)]
    assert [rule.selectors[0].parts[-1].classes for rule in found] == [["b"], ["c"], ["a"]]


def test_a_long_selector_is_compared_without_trying_all_ways() -> None:
    sheet = css.Sheet()
    sheet.add("g " * 500 + ".x .a { filter: x }", {"filter"})
    assert sheet.styles((*((("g", {}),) * 190), ("rect", {"class": "a"}))) == []
