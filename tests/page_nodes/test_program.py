"""What a page may send as a program."""

from __future__ import annotations

import pytest

from thymio_sim_ros.page_nodes.program import MAX_BYTES, NodeProgram, ProgramRefusedError, program_of


def test_a_program_has_a_file_name_and_the_namespace_of_its_robot() -> None:
    program = program_of({"text": "import rclpy", "name": "A node on the line.py", "namespace": "/thymio_1"})
    assert program == NodeProgram("A node on the line.py", "import rclpy", "/thymio_1")
    assert program.arguments == ("--ros-args", "-r", "__ns:=/thymio_1")
    assert program_of({"text": ""}).arguments == ()
    assert program_of({"text": "", "sim_time": True}).arguments == ("--ros-args", "-p", "use_sim_time:=true")
    assert program_of({"text": "", "sim_time": "yes"}).arguments == ()


@pytest.mark.parametrize(
    "name", ["../../etc/passwd.py", "-c.py", ".py", "a.txt", "x" * 200 + ".py", "a\n.py", "", 7, None]
)
def test_a_name_that_is_none_of_a_file_is_replaced(name: object) -> None:
    assert program_of({"text": "", "name": name}).name == "program.py"


@pytest.mark.parametrize(
    ("message", "reason"),
    [
        ({}, "found no text"),
        ({"text": 5}, "found no text"),
        ({"text": "a\nb = '\ud800'"}, "line 2: found half of a character"),
        ({"text": "a\n\nb\0"}, "line 3: found the character NUL"),
        ({"text": "#" * (MAX_BYTES + 1)}, "at most 100 kB"),
        ({"text": "é" * (MAX_BYTES // 2 + 1)}, "at most 100 kB"),
        ({"text": "", "namespace": "thymio"}, "expected one such as /thymio_1"),
        ({"text": "", "namespace": "/a -p x:=1"}, "expected one such as /thymio_1"),
        ({"text": "", "namespace": None}, "expected one such as /thymio_1"),
    ],
)
def test_anything_else_is_refused_with_the_place(message: dict[str, object], reason: str) -> None:
    with pytest.raises(ProgramRefusedError, match=reason):
        program_of(message)
