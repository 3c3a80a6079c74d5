"""A playground by name, path, text or upload."""

from __future__ import annotations

import base64
import errno
import json
import os
import zipfile
from pathlib import Path

import pytest

from tests.sim.builders import FLOOR, ROBOT
from thymio_sim_ros.files import resources
from thymio_sim_ros.files.loading import is_playground_text, load_playground, read_program, read_text
from thymio_sim_ros.files.resources import ResourceError
from thymio_sim_ros.sim.playground.reader import PlaygroundError

OURS = json.dumps({"format": 1, "title": "Ours", "shapes": [FLOOR], "robots": [ROBOT]})
ASEBA = (
    '<aseba-playground><color name="w" r="1" g="1" b="1"/><world w="100" h="100" color="w"/>'
    '<robot x="50" y="50"/></aseba-playground>'
)
THESIS = json.dumps(
    {"playground": "Base", "planes": [{"props": {"width": 50, "height": 50, "color": "#bdbbbb"}, "hasWalls": True}]}
)


def upload(text: str, name: str = "my%20maze.json") -> str:
    return f"data:application/octet-stream;name={name};base64,{base64.b64encode(text.encode()).decode()}"


@pytest.mark.parametrize(("text", "title"), [(OURS, "Ours"), (THESIS, "Base"), (ASEBA, "uploaded playground")])
def test_a_text_of_any_format_is_named_by_its_title(text: str, title: str) -> None:
    name, loaded = load_playground("\n " + text)
    assert (name, loaded.title, len(loaded.robots)) == (title, title, 1)


@pytest.mark.parametrize("text", [OURS, THESIS, ASEBA])
def test_a_file_of_any_format_is_accepted_by_its_path(tmp_path: Path, text: str) -> None:
    path = tmp_path / "mine.playground"
    path.write_text(text)
    assert load_playground(str(path))[0] == "mine"


@pytest.mark.parametrize("text", [OURS, THESIS, ASEBA])
def test_an_upload_is_named_by_its_file(text: str) -> None:
    name, loaded = load_playground(upload(text))
    assert (name, loaded.name, len(loaded.robots)) == ("my maze.json", "my maze", 1)


def several(folder: Path) -> Path:
    """An archive of two playgrounds."""
    path = folder / "maps.zip"
    with zipfile.ZipFile(path, "w") as packed:
        packed.writestr("maps/a.playground", ASEBA)
        packed.writestr("maps/b.json", OURS)
    return path


def test_one_of_several_playgrounds_in_an_archive_is_named_behind_its_path(tmp_path: Path) -> None:
    path = several(tmp_path)
    for part, title in (("a", "a"), ("maps/a.playground", "a"), ("b.json", "Ours")):
        name, loaded = load_playground(f"{path}#{part}")
        assert (name, loaded.title) == (Path(part).stem, title)
    with pytest.raises(PlaygroundError, match=r'2 playgrounds in the archive \("maps/a.playground", "maps/b.json"\)'):
        load_playground(str(path))


def test_a_file_may_have_a_number_sign_in_its_name(tmp_path: Path) -> None:
    path = tmp_path / "maze #2.json"
    path.write_text(OURS)
    assert load_playground(str(path))[0] == "maze #2"
    with pytest.raises(ResourceError):
        load_playground(str(tmp_path / "missing.zip#a"))


def test_one_of_several_playgrounds_in_an_upload_is_a_part_of_it(tmp_path: Path) -> None:
    content = base64.b64encode(several(tmp_path).read_bytes()).decode()
    name, loaded = load_playground(f"data:application/octet-stream;name=maps.zip;part=maps%2Fb.json;base64,{content}")
    assert (name, loaded.title) == ("maps.zip#maps/b.json", "Ours")


def test_an_installed_playground_is_read_once_until_its_file_changes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "ours.json"
    monkeypatch.setattr(resources, "playgrounds", lambda: {"ours": file})
    file.write_text(OURS)
    os.utime(file, ns=(0, 1_000_000_000))
    _, first = load_playground("ours")
    assert load_playground(str(file))[1] is first
    file.write_text(OURS.replace("Ours", "Mine"))
    os.utime(file, ns=(0, 2_000_000_000))
    assert load_playground("ours")[1].title == "Mine"


def test_errors_of_an_upload_name_its_file() -> None:
    with pytest.raises(PlaygroundError, match=r"^my maze\.json: format: found"):
        load_playground(upload("{}"))


def test_errors_of_a_text_without_a_name_say_so() -> None:
    with pytest.raises(PlaygroundError, match=r"^uploaded playground: format: found"):
        load_playground("{}")


def test_an_upload_that_is_not_base64_is_refused() -> None:
    with pytest.raises(PlaygroundError, match="base64"):
        load_playground("data:;name=a.json;base64,###")


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "iso-8859-1"])
def test_a_program_is_read_in_the_encoding_that_it_says(tmp_path: Path, encoding: str) -> None:
    path = tmp_path / "grün.aesl"
    text = f'<?xml version="1.0" encoding="{encoding}"?>\n<network><node name="thymio-II"># größer</node></network>'
    path.write_bytes(text.encode(encoding))
    assert read_text(str(path)) == (text, "grün.aesl")


def test_a_program_that_is_no_text_is_refused_with_its_place(tmp_path: Path) -> None:
    path = tmp_path / "latin.aesl"
    path.write_bytes(b"var a\n# gr\xfcn")
    with pytest.raises(
        resources.ResourceError, match=r"latin\.aesl: line 2, column 5: found byte fc, expected text in"
    ):
        read_text(str(path))


def test_a_program_that_cannot_be_read_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(path: Path) -> bytes:
        raise PermissionError(errno.EACCES, "Permission denied", str(path))

    path = tmp_path / "secret.aesl"
    path.touch()
    monkeypatch.setattr(Path, "read_bytes", refuse)
    with pytest.raises(resources.ResourceError, match=r"secret\.aesl: Permission denied; expected a file that can be"):
        read_text(str(path))


@pytest.mark.parametrize(
    "content",
    [
        b"root:x:0:0:hunter2:/root",
        b'{"auths": {"registry": "hunter2"}}',
        b'{"pw": hunter2}',
        b"<hunter2/>",
        b"<svg><text>hunter2</text>",
        b"\xffhunter2",
        b"hunter2",
    ],
)
@pytest.mark.parametrize("zipped", [False, True])
def test_an_error_quotes_nothing_of_a_file_that_is_no_playground(tmp_path: Path, content: bytes, zipped: bool) -> None:
    path = tmp_path / "config.json"
    path.write_bytes(content)
    if zipped:
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("inside.json", content)
    with pytest.raises(PlaygroundError) as caught:
        load_playground(str(path))
    assert "hunter2" not in str(caught.value)
    assert caught.value.__suppress_context__
    assert "aseba-playground" in caught.value.expected


@pytest.mark.parametrize(
    ("content", "hint"),
    [
        ("<network></network>", "this is a program, which --program takes"),
        ("import rclpy\n", "this is a ROS node"),
        ("from tdmclient import aw\n", "this is a Python program for tdmclient"),
        ('{"advancedBlocks": [], "program": [], "blocks": 1}', "this is a program of VPL 3"),
    ],
)
def test_a_program_in_place_of_a_playground_is_recognized(tmp_path: Path, content: str, hint: str) -> None:
    path = tmp_path / "mine.playground"
    path.write_text(content)
    with pytest.raises(PlaygroundError, match=hint):
        load_playground(str(path))


@pytest.mark.parametrize("content", ['{"format": 1, "titel": "x"}', '{"format": 2}', "<aseba-playground><wall/>"])
def test_an_error_about_a_playground_says_what_is_wrong(tmp_path: Path, content: str) -> None:
    path = tmp_path / "mine.json"
    path.write_text(content)
    with pytest.raises(PlaygroundError) as caught:
        load_playground(str(path))
    assert "not a playground" not in str(caught.value)


@pytest.mark.parametrize("name", ["passwd", "key.pem", "settings.json", ".env"])
def test_a_file_that_is_no_program_by_its_name_is_not_read(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text("hunter2 = 1")
    with pytest.raises(ResourceError, match=r"ends in \.aesl"):
        read_text(str(tmp_path / name))


@pytest.mark.parametrize(
    ("value", "is_text"),
    [
        ("line", False),
        ("/etc/passwd", False),
        ("C:\\x.json", False),
        ("data:text/plain,hello", False),
        ('{"format": 1}', True),
        ("\ufeff <aseba-playground/>", True),
        ("data:;name=a;base64,e30=", True),
    ],
)
def test_what_is_content_opens_no_file(value: str, is_text: bool) -> None:
    assert is_playground_text(value) is is_text


@pytest.mark.parametrize(
    "name",
    ["follower.aesl.txt", "follower (1).aesl", "follower - Copy.aesl", "FOLLOWER.AESL", "follower.aesl.download"],
)
def test_names_that_browsers_and_windows_give_are_names_of_programs(tmp_path, name):
    (tmp_path / name).write_text("var a = 1")
    assert read_text(str(tmp_path / name)) == ("var a = 1", name)


def test_a_network_is_opened_whatever_its_name_is(tmp_path):
    path = tmp_path / "follower.xml"
    path.write_text("<network><node>var a</node></network>")
    assert read_program(str(path)).source == "var a"


def test_of_another_file_only_its_kind_is_said(tmp_path):
    (tmp_path / "secret.conf").write_text("password = 1")
    with pytest.raises(ResourceError, match=r"secret\.conf: expected a file whose name ends in \.aesl"):
        read_text(str(tmp_path / "secret.conf"))
    (tmp_path / "lesson.vpl3").write_text('{"basicBlocks": [], "program": []}')
    with pytest.raises(ResourceError, match=r"lesson\.vpl3: this is a program of VPL 3; open it"):
        read_text(str(tmp_path / "lesson.vpl3"))
