"""A class: names of pupils, its folder, requests to it, what suites of pupils send; assignments and submissions."""

from __future__ import annotations

import asyncio
import io
import json
import shutil
import zipfile
from collections.abc import Iterator
from functools import cache

from tests.classroom.test_requests import OPTIONS, PLACE, PUPIL
from tests.fuzz.target import FOLDER, Target, lines, text
from thymio_sim_ros.access import RefusedError
from thymio_sim_ros.bridge.protocol.wire import data_head
from thymio_sim_ros.classroom.bridge_client import BridgeClient
from thymio_sim_ros.classroom.cdr import CdrError, read_diagnostic, read_string
from thymio_sim_ros.classroom.classroom import Classroom
from thymio_sim_ros.classroom.errors import ClassError
from thymio_sim_ros.classroom.folder import ClassFolder
from thymio_sim_ros.classroom.handouts import Handouts
from thymio_sim_ros.classroom.pupils import MAX_NAME, folder_name, read_pupils
from thymio_sim_ros.classroom.requests import answer
from thymio_sim_ros.classroom.seat import Seat
from thymio_sim_ros.grading import assignment
from thymio_sim_ros.grading.archives import RejectedError, read_zip
from thymio_sim_ros.grading.errors import GradingError
from thymio_sim_ros.grading.sandbox.report_protocol import ForgedError, ReportProtocol
from thymio_sim_ros.grading.submissions import find, prepared

SECRET = "s3cret"
NESTED = b"[" * 3000


def _pupils(data: bytes) -> None:
    names = read_pupils(data, "names.csv")
    assert len(set(names)) == len(names)
    for name in names:
        assert 0 < len(name) <= MAX_NAME
        assert folder_name(folder_name(name)) == folder_name(name)


def _folder(data: bytes) -> None:
    path = FOLDER / "class"
    path.mkdir(exist_ok=True)
    (path / "class.json").write_bytes(data)
    places = ClassFolder(path).places(["Ada", "Ben"])
    assert ClassFolder(path).places(["Ada", "Ben"]) == places


@cache
def _classroom() -> Classroom:
    path = FOLDER / "open class"
    shutil.rmtree(path, ignore_errors=True)
    folder = ClassFolder(path)
    return Classroom(folder.places(["Ada", "Ben"]), OPTIONS, folder)


def _request(data: bytes) -> None:
    """A request with the token of the teacher."""
    name, body = lines(data, 2)
    asyncio.run(answer(_classroom(), PLACE, PUPIL, "POST", name.decode("latin-1"), body))


def _suite(data: bytes) -> None:
    """What the suite of a pupil sends to the class, which any node of the pupil can publish, too."""
    folder = ClassFolder(FOLDER / "open class")
    (place,) = folder.places(["Ada"])
    seat = Seat(place, OPTIONS, folder, Handouts(folder.handouts))
    seat._client = client = BridgeClient("ws://localhost:1/", "token", seat._on_parameter, seat._on_try)
    client._topics = {
        1: "/simulator/_state",
        2: "/simulator/_overview",
        3: "/_aseba/status",
        4: "/simulator/_mission/try",
    }
    for part in data.split(b"\n--\n"):
        asyncio.run(client._receive(text(part) if part.startswith(b"{") else part))
        json.dumps(seat.summary(), allow_nan=False).encode()


def _assignment(data: bytes) -> None:
    path = FOLDER / "task.toml"
    path.write_bytes(data)
    assignment.load(path)


def _archive(data: bytes) -> None:
    for name in read_zip(data):
        assert not name.startswith("/")
        assert ".." not in name.split("/")


def _class_archive(data: bytes) -> None:
    path = FOLDER / "class.zip"
    path.write_bytes(data)
    for submission in find(path):
        prepared(submission, ["program.aesl"])


def _report(data: bytes) -> None:
    """Lines of a test process that knows the secret."""
    protocol = ReportProtocol(SECRET, None)
    for line in data.split(b"\n"):
        kind, _ = protocol.read(line)
        assert kind in ("collected", "broken", "begin", "result", "end")


def _names() -> Iterator[bytes]:
    yield "First name;Last name\nAda;Lovelace\n\"Müller\";'Bo'\n".encode("cp1252")
    yield b"name\nAda\nBen\n"


def _class_files() -> Iterator[bytes]:
    path = FOLDER / "seed class"
    ClassFolder(path).places(["Ada", "Ben"])
    yield (path / "class.json").read_bytes()


def _requests() -> Iterator[bytes]:
    for name, fields in (
        ("message", {"pupils": ["ben"], "text": "Look up"}), ("show", {"pupil": "ada"}), ("pause", {"paused": 1}),
    ):  # fmt: skip
        yield name.encode() + b"\n" + json.dumps(fields).encode()
    yield b"message\n" + NESTED


def _string(content: str) -> bytes:
    data = content.encode() + b"\0"
    return len(data).to_bytes(4, "little") + data + bytes(-len(data) % 4)


def _messages() -> Iterator[bytes]:
    yield b"\0\1\0\0" + _string('{"robots": [{"robot": "thymio", "fallen": true}], "paused": false}')
    parts = b"".join(map(_string, ("runtime", "runs", "")))
    yield b"\0\1\0\0\2\0\0\0" + parts + b"\1\0\0\0" + _string("state") + _string("b")


def _from_suite() -> Iterator[bytes]:
    for number, payload in enumerate(_messages(), 1):
        for topic in (number, 3):
            yield data_head(topic, 0) + payload
        yield data_head(number, 0) + b"\0\1\0\0" + _string(NESTED.decode())
    value = {"name": "/aseba_runtime.script.source", "value": "motor.left.target = 1"}
    yield json.dumps({"op": "parameterValues", "parameters": [value]}).encode()
    channel = {"id": 7, "topic": "/simulator/_state", "encoding": "cdr", "schemaName": "std_msgs/String", "schema": ""}
    yield json.dumps({"op": "advertise", "channels": [channel]}).encode() + b"\n--\n" + data_head(7, 0)


def _zips() -> Iterator[bytes]:
    inner = io.BytesIO()
    with zipfile.ZipFile(inner, "w") as archive:
        archive.writestr("program.aesl", b"a = 1")
    for names in (("ada/program.aesl", "ben/x.aesl"), ("ada.zip", "Bo_12345_assignsubmission_file_/program.aesl")):
        for method in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            packed = io.BytesIO()
            with zipfile.ZipFile(packed, "w", method) as archive:
                for name in names:
                    archive.writestr(name, inner.getvalue() if name.endswith(".zip") else b"onevent prox")
            yield packed.getvalue()


def _reports() -> Iterator[bytes]:
    head = {"secret": SECRET}
    rows = (
        head | {"do": "collected", "tests": [["t.py::a", "3"]], "notes": []}, head | {"do": "begin", "test": "t.py::a"},
        head | {"do": "result", "test": "t.py::a", "phase": "", "outcome": "passed", "message": ""},
        head | {"do": "end"},
    )  # fmt: skip
    yield b"\n".join(json.dumps(row).encode() for row in rows)


LIMITS = ("limits.cpu_s = 1", "tests = [", "hidden = [", "1979-05-27", "inf", "'''", "[limits]", "[[limits]]")
TARGETS = (
    Target("pupils", _pupils, (ClassError,), _names, ("name", "Vorname", "nom", '"', ";", "\t")),
    Target("class-folder", _folder, (ClassError,), _class_files, ('"pupils":', '"number":', '"token":', "null")),
    Target("class-request", _request, (RefusedError,), _requests, ("message", "restart", "pause", '"pupils":')),
    Target("class-string", read_string, (CdrError,), _messages),
    Target("class-diagnostic", read_diagnostic, (CdrError,), _messages),
    Target("class-suite", _suite, (), _from_suite, ('"paused":', '"robots":', '"fallen":', "NaN", "\\ud800")),
    Target(
        "assignment", _assignment, (GradingError,), lambda: [b'hidden = ["task.toml"]\n[limits]\ncpu_s = 3\n'], LIMITS
    ),
    Target("submission", _archive, (RejectedError,), _zips, ("../", "PK\x01\x02", "PK\x05\x06")),
    Target("class-archive", _class_archive, (GradingError,), _zips, ("_assignsubmission_file_", "__MACOSX")),
    Target("test-report", _report, (ForgedError,), _reports, ('"secret":"s3cret"', '"do":', '"_eq__"')),
)
