"""Files of other programs: recognized by content, and never a program in Aseba."""

import io
import zipfile

import pytest

from aseba_vm import aesl
from aseba_vm.aesl.foreign_files import looks_like_network
from aseba_vm.aesl.text_decoding import decode
from aseba_vm.errors import TextError


def packed(*names):
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        for name in names:
            archive.writestr(name, "x")
    return file.getvalue()


def network_of(data):
    text = decode(data).text
    return aesl.loads(text, strict=True) if aesl.is_aesl(text) else aesl.bare(text, "")


@pytest.mark.parametrize(
    ("data", "kind"),
    [
        (packed("[Content_Types].xml", "word/document.xml"), "document"),
        (packed("mimetype", "content.xml").replace(b"x", b"vnd.oasis.opendocument", 1), "document"),
        (packed("project.json", "0.png"), "scratch"),
        (packed("a.aesl"), "archive"),
        (b"\x1f\x8b\x08\x00", "archive"),
        (b"%PDF-1.7\n", "pdf"),
        (b"\x89PNG\r\n\x1a\n", "picture"),
        (b"\xff\xd8\xff\xe0", "picture"),
        (b'<?xml version="1.0"?>\n<!-- a --><!-- b -->\n<svg xmlns="http://www.w3.org/2000/svg"/>', "picture"),
        (b"<!DOCTYPE html>\n<html><body>Sign in</body></html>", "web-page"),
        (b"<HTML><head></head></HTML>", "web-page"),
        (b"<!DOCTYPE aseba-playground>\n<aseba-playground><world/></aseba-playground>", "playground"),
        (b'{"format": 1, "title": "A", "shapes": [], "robots": []}', "playground"),
        (b'<xml xmlns="https://developers.google.com/blockly/xml"></xml>', "blocks"),
        (b'{"advanced": false, "program": [{"blocks": [{"name": "move", "param": [1]}]}]}', "vpl3"),
        (b'{"basicBlocks": ["init"], "program": []}', "vpl3"),
        (b'{"cells": [{"cell_type": "code"}], "nbformat": 4}', "notebook"),
        (b'{"a": 1}', "json"),
        (b"import rclpy\nfrom rclpy.node import Node\n", "ros"),
        (b"#include <rclcpp/rclcpp.hpp>\nint main() {}\n", "ros"),
        (b"@onevent\ndef prox():\n    pass\n", "tdmclient"),
        (b"from tdmclient import ClientAsync\n", "tdmclient"),
        (b"while True:\n    motor_left_target = 100\n", "tdmclient"),
        ('\ufeffprint("a")\n'.encode("utf-16"), "python"),
        (b"#!/usr/bin/env python3\nimport time\n", "python"),
    ],
)
def test_a_file_of_another_program_is_named(data, kind):
    with pytest.raises(TextError) as caught:
        network_of(data)
    assert caught.value.kind == f"foreign-{kind}"
    assert str(caught.value).startswith("th")


@pytest.mark.parametrize(
    "text",
    [
        "",
        "# import rclpy\nvar a",
        "#*\nimport rclpy\ndef a():\n*#\nvar a",
        "onevent prox\nif prox.horizontal[2] > 0 then:\nend",
        "if a == 1:\nend",
        "BM",
        "var import = 1",
        "var motor_left = 1\nprint = 2",
        '<network><node name="a"># &lt;svg&gt; import rclpy\nvar a</node></network>',
    ],
)
def test_a_program_is_not_taken_for_another_file(text):
    assert len(network_of(text.encode()).nodes) == 1


def test_a_network_is_recognized_behind_comments():
    assert looks_like_network('\ufeff<?xml version="1.0"?>\n<!-- a --><!-- b -->\n<network/>')
    assert looks_like_network("<!DOCTYPE aesl-source>")
    assert not looks_like_network("<!-- <network> -->")
