"""From the code of a node back to the file."""

from __future__ import annotations

import pytest

from thymio_sim_ros.device.places import place_in_file


@pytest.mark.parametrize(
    ("text", "offset", "place"),
    [
        ("<node>ab\ncd</node>", 0, (0, 6)),
        ("<node>ab\ncd</node>", 4, (1, 1)),
        ("<node>ab\ncd</node>", 99, (1, 2)),
        ("<node>a&lt;b</node>", 1, (0, 7)),
        ("<node>a&lt;b</node>", 2, (0, 11)),
        ("<node>a<!-- x\n -->b</node>", 1, (1, 4)),
        ("<node>a<x y='1'/>b</node>", 1, (0, 17)),
        ("<node>a<![CDATA[b<c]]>d</node>", 2, (0, 17)),
        ("<node>a<![CDATA[b<c]]>d</node>", 4, (0, 22)),
    ],
)
def test_a_character_of_the_code_is_found_in_the_text(text, offset, place):
    assert place_in_file(text, 0, len("<node>"), offset) == place


def test_code_that_begins_in_cdata_is_found():
    text = "<node>\n<![CDATA[a < b]]></node>"
    assert place_in_file(text, 1, len("<![CDATA["), 4) == (1, 13)
