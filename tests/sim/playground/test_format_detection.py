"""Which format a file has, archives, and what is never unpacked nor read."""

from __future__ import annotations

import contextlib
import io
import json
import os
import struct
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from tests.patience import PATIENCE_S
from tests.sim.builders import FLOOR, ROBOT
from tests.sim.images import BLACK, WHITE, png
from thymio_sim_ros.sim.model.primitives import Print
from thymio_sim_ros.sim.playground import format_detection, reader
from thymio_sim_ros.sim.playground.reader import PlaygroundError

WORLD = (
    '<aseba-playground><color name="w" r="1" g="1" b="1"/>'
    '<world w="100" h="100" color="w" groundTexture="ground.png"/><robot x="50" y="50"/></aseba-playground>'
)
ASEBA_ZOE = (
    "<aseba-playground><description>Zoë &ndash; ok</description>"
    '<color name="w" r="1" g="1" b="1"/><world w="100" h="100" color="w"/><robot x="50" y="50" name="Zoë"/>'
    "</aseba-playground>"
)
OURS = json.dumps(
    {
        "format": 1,
        "title": "Ours",
        "shapes": [FLOOR, {"kind": "picture", "image": "ground.png", "size_x_m": 1}],
        "robots": [ROBOT],
    }
)
PICTURE = png([[WHITE, BLACK]])


def archive(method: int = zipfile.ZIP_DEFLATED, /, **files: bytes | str) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", method) as packed:
        for name, content in files.items():
            packed.writestr(name, content)
    return out.getvalue()


def refused(data: bytes) -> PlaygroundError:
    with pytest.raises(PlaygroundError) as caught:
        reader.loads(data, "mine.zip")
    return caught.value


@pytest.mark.parametrize("home", ["", "maze/"])
@pytest.mark.parametrize(("inner", "text"), [("world.xml", WORLD), ("mine.json", OURS), ("mine.playground", WORLD)])
def test_an_archive_holds_a_playground_and_its_pictures(home: str, inner: str, text: str) -> None:
    data = archive(**{home + inner: text, home + "ground.png": PICTURE})
    loaded = reader.loads(data, "mine.playground")
    assert (loaded.name, [type(mark) for mark in loaded.paints]) == ("mine", [Print])


def test_an_archive_is_read_by_its_path_too(tmp_path: Path) -> None:
    path = tmp_path / "maze.playground"
    path.write_bytes(archive(**{"world.xml": WORLD, "ground.png": PICTURE}))
    assert reader.load(path).title == "maze"


def test_a_playground_file_finds_its_image_in_its_folder(tmp_path: Path) -> None:
    (tmp_path / "maze.playground").write_text(WORLD)
    (tmp_path / "ground.png").write_bytes(PICTURE)
    assert len(reader.load(tmp_path / "maze.playground").paints) == 1


def test_a_text_alone_cannot_have_an_image_beside_it() -> None:
    with pytest.raises(PlaygroundError, match=r"groundTexture \(shapes\[1\].image\): found the file 'ground.png'"):
        reader.loads(WORLD, "mine.playground")


@pytest.mark.parametrize(
    ("encoding", "declared"),
    [
        *(("utf-8-sig", each) for each in ("", "utf-8")),
        *(("utf-16", each) for each in ("", "utf-16")),
        ("utf-16-be", "UTF-16"),
        ("iso-8859-1", "iso-8859-1"),
        ("iso-8859-15", "ISO-8859-15"),
        ("windows-1252", "windows-1252"),
    ],
)
def test_a_playground_of_aseba_may_have_any_encoding(encoding: str, declared: str) -> None:
    head = f'<?xml version="1.0" encoding="{declared}"?>' if declared else ""
    loaded = reader.loads(f"{head}{ASEBA_ZOE}".encode(encoding), "zoe")
    assert [robot.name for robot in loaded.robots] == ["zoe"]
    assert loaded.description == "Zoë – ok"
    assert loaded.notes == ()


@pytest.mark.parametrize("head", ["", '<?xml version="1.0" encoding="UTF-8"?>'])
def test_a_text_that_is_not_in_its_encoding_is_read_as_older_programs_wrote_it(head: str) -> None:
    loaded = reader.loads(f"{head}{ASEBA_ZOE}".encode("windows-1252"), "zoe")
    assert [robot.name for robot in loaded.robots] == ["zoe"]
    assert loaded.notes == ("read as Windows-1252, as the file is not in UTF-8",)


def test_json_in_utf_16_is_read() -> None:
    text = json.dumps({"format": 1, "title": "Zoë", "shapes": [FLOOR], "robots": [ROBOT]}, ensure_ascii=False)
    assert reader.loads(text.encode("utf-16"), "zoe").title == "Zoë"


def test_a_byte_order_mark_does_no_harm() -> None:
    text = b"\xef\xbb\xbf" + json.dumps({"format": 1, "title": "x", "shapes": [FLOOR]}).encode()
    assert reader.loads(text, "mine").title == "x"


@pytest.mark.parametrize(
    "files",
    [
        {"readme.txt": "nothing"},
        {"a.json": OURS, "b.json": OURS},
        {"a.json": "[]", "b.json": "{}"},
        {},
    ],
)
def test_an_archive_without_one_playground_is_refused(files: dict[str, str]) -> None:
    assert refused(archive(**files) if files else b"PK\x03\x04").path == "mine.zip"


SEVERAL = {
    "maps/a.playground": ASEBA_ZOE,
    "maps/b.playground": ASEBA_ZOE.replace("Zoë", "Bo"),
    "maps/more/b.json": json.dumps({"format": 1, "title": "B", "shapes": [FLOOR], "robots": [ROBOT]}),
    "package.json": '{"name": "maps"}',
}


def test_an_archive_of_several_playgrounds_names_them() -> None:
    data = archive(**SEVERAL)
    error = refused(data)
    assert error.found == '3 playgrounds in the archive ("maps/a.playground", "maps/b.playground", "maps/more/b.json")'
    assert error.expected == "the name of one, as FILE#maps/a.playground"
    assert format_detection.is_recognized(data)


@pytest.mark.parametrize(
    ("part", "robot"), [("maps/b.playground", "bo"), ("a.playground", "zoe"), ("a", "zoe"), ("b.json", ROBOT["name"])]
)
def test_one_of_several_playgrounds_is_chosen_by_its_name(part: str, robot: str) -> None:
    loaded = reader.loads(archive(**SEVERAL), "maps.zip", part)
    assert [start.name for start in loaded.robots] == [robot]
    assert loaded.name == Path(part).stem


@pytest.mark.parametrize("part", ["b", "c", "package.json", "maps"])
def test_a_name_that_none_or_two_have_is_refused(part: str) -> None:
    with pytest.raises(PlaygroundError, match=f"none of them '{part}'"):
        reader.loads(archive(**SEVERAL), "maps.zip", part)


def test_a_chosen_playground_has_the_images_beside_it() -> None:
    files = {f"{home}/world.xml": WORLD for home in ("north", "south")} | {"south/ground.png": PICTURE}
    assert len(reader.loads(archive(**files), "maps.zip", "south/world.xml").paints) == 1


def test_a_file_of_another_kind_beside_a_playground_is_no_choice() -> None:
    files = {"a.playground": ASEBA_ZOE, "package.json": "{}", "pom.xml": "<project/>"}
    assert [robot.name for robot in reader.loads(archive(**files), "mine.zip").robots] == ["zoe"]


def test_a_part_of_what_is_no_archive_is_refused() -> None:
    with pytest.raises(PlaygroundError, match="'#a' behind the name of a file that is no archive"):
        reader.loads(ASEBA_ZOE, "mine.playground", "a")


@pytest.mark.parametrize("name", ["../secret.png", "/etc/secret.png", "..\\secret.png", "folder/../ground.png"])
def test_an_image_outside_the_archive_is_refused(name: str) -> None:
    data = archive(**{"world.xml": WORLD.replace("ground.png", name), name: PICTURE, "ground.png": PICTURE})
    assert "shapes[1].image" in refused(data).key


def test_an_image_that_is_missing_in_the_archive_is_named() -> None:
    error = refused(archive(**{"world.xml": WORLD}))
    assert (error.found, error.expected) == ("'ground.png'", "a file in the archive")


def test_an_archive_that_decompresses_without_limit_is_not_extracted() -> None:
    assert "more than 32000000 bytes" in refused(archive(**{"world.xml": " " * 50_000_000})).found
    bomb = archive(**{"world.xml": WORLD, "ground.png": b"\0" * 50_000_000})
    assert "expected" in str(refused(bomb))


def test_an_archive_of_too_many_files_is_refused() -> None:
    assert "201 files" in refused(archive(**{f"{i}.txt": "" for i in range(201)})).found


def test_a_damaged_archive_is_refused() -> None:
    data = bytearray(archive(**{"world.xml": WORLD}))
    data[45:60] = b"\xff" * 15
    assert refused(bytes(data)).path == "mine.zip"


@pytest.mark.parametrize("method", [zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_an_archive_damaged_anywhere_is_refused_or_read(method: int) -> None:
    whole = archive(method, **{"world.xml": WORLD, "ground.png": PICTURE})
    for place in range(len(whole)):
        for value in (0x00, 0x7F, 0xFF):
            data = bytearray(whole)
            data[place] = value
            with contextlib.suppress(PlaygroundError):  # any other error fails the test
                reader.loads(bytes(data), "mine.zip")


def test_an_encrypted_archive_is_refused() -> None:
    data = bytearray(archive(**{"world.xml": WORLD}))
    for signature, offset in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        start = data.index(signature) + offset
        struct.pack_into("<H", data, start, 1)
    assert "cannot be extracted" in refused(bytes(data)).found


def test_other_json_is_taken_for_ours() -> None:
    assert refused(b'{"answer": 42}').key == "format"


def test_a_file_that_is_too_large_is_refused() -> None:
    assert "more than" in refused(b" " * (format_detection.MAX_BYTES + 1)).found


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('{"title": "NaN",\n "format": NaN}', "t: line 2, column 12: found NaN, expected finite numbers"),
        ('{"format": [1, -Infinity]}', "t: line 1, column 16: found -Infinity, expected finite numbers"),
        ('{"a\\ud800": 1}', "t: found an unpaired surrogate in the key 'a\\ud800', expected valid Unicode"),
        (
            '{"\\ud83e\\udd16": {"x": 1,\n "y": 1, "x": 2}}',
            "t: line 2, column 10: found the duplicate key 'x', expected",
        ),
        ('{"x": {"x": "x", "a": ["x"]}, "x": 1}', "t: line 1, column 31: found the duplicate key 'x', expected unique"),
        ('{"format": 1,\n', "t: line 2, column 1: found the end of the text, expected JSON (Expecting property name"),
        (
            '{"format": 1 "title": ""}',
            "t: line 1, column 14: found '\"title\": \"\"}', expected JSON (Expecting ',' delimi",
        ),
    ],
)
def test_a_fault_of_the_text_is_told_with_its_place(text: str, message: str) -> None:
    with pytest.raises(PlaygroundError) as caught:
        reader.loads(text, "t")
    assert str(caught.value).startswith(message)


MEMORY = """
import resource, time
from thymio_sim_ros.files.loading import load_playground
from thymio_sim_ros.sim.playground.reader import PlaygroundError
text = {text}
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
begin = time.process_time()
try:
    load_playground(text)
except PlaygroundError as error:
    assert len(str(error)) < 5000, len(str(error))
    print(time.process_time() - begin, (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024)
"""
HUGE = {
    "text": """'{"format":1,"title":"x","description":"' + "a" * 20_000_000 + '"}'""",
    "wide text": """'{"format":1,"title":"x","description":"' + "a" * 20_000_000 + chr(0x1f600) + '"}'""",
    "escapes": """'{"format":1,"title":"x","description":"' + "\\\\n" * 10_000_000 + '"}'""",
    "key": """'{"format":1,"' + "a" * 20_000_000 + '":1}'""",
    "picture": """'{"format":1,"shapes":[{"image":"data:' + "a" * 20_000_000 + '"}]}'""",
    "text before a fault": """'{"title":"' + "a" * 20_000_000 + '","x":NaN}'""",
    "lists": """'{"shapes":[' + "[]," * 6_600_000""",
    "nested lists": """'{"shapes":' + "[" * 20_000_000""",
    "quotes": """'{' + '""' * 10_000_000""",
    "numbers": """'{"shapes":[' + "1," * 990_000 + "1]}" """,
    "text of XML": """"<aseba-playground><a>" + "a\\n" * 10_000_000 + "</a></aseba-playground>" """,
    "attribute of XML": """'<a b="' + "a " * 10_000_000 + '"/>'""",
    "tag of XML": """"<" + "a" * 20_000_000 + "/>" """,
    "nested XML": """"<a>" * 6_000_000""",
    "elements of XML": """"<a>" + "<b/>" * 5_000_000""",
}
LANDING = ("text", "nested lists", "numbers", "attribute of XML", "nested XML")
"""One of each kind of fault, for `make test`."""


@pytest.mark.process
@pytest.mark.skipif(sys.platform == "win32", reason="measures memory as POSIX does")
@pytest.mark.parametrize(
    "kind", [pytest.param(kind, marks=() if kind in LANDING else pytest.mark.slow) for kind in HUGE]
)
def test_a_huge_text_is_refused_at_little_cost(kind: str) -> None:
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    code = MEMORY.format(text=HUGE[kind])
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, timeout=PATIENCE_S
    )
    assert done.returncode == 0, done.stderr
    cpu_s, megabytes = map(float, done.stdout.split())
    assert megabytes < 150
    assert cpu_s < 5  # of a slow machine; 1 s is the aim


@pytest.mark.parametrize(("open_", "close"), [("[", "]"), ('{"a":', "}")])
@pytest.mark.parametrize("depth", [50, 500, 5_000, 50_000])
def test_nested_json_is_refused_with_a_short_error(open_: str, close: str, depth: int) -> None:
    nested = open_ * depth + "1" + close * depth
    for text in (nested, f'{{"format":1,"title":{nested}}}', f'{{"format":1,"shapes":[{nested}]}}'):
        assert len(str(refused(text.encode()))) < 1000


def test_a_text_that_is_too_long_is_refused_with_its_place() -> None:
    error = refused(b'{"format": 1,\n "title": "' + b"a" * format_detection.MAX_TEXT + b'"}')
    assert (error.key, error.found) == ("line 2, column 11", f"a string of {format_detection.MAX_TEXT + 2} bytes")
