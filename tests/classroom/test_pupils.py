"""Names of pupils from a CSV file."""

from __future__ import annotations

import pytest

from thymio_sim_ros.classroom.errors import ClassError
from thymio_sim_ros.classroom.pupils import folder_name, read_pupils


@pytest.mark.parametrize(
    "text",
    [
        "Jürg Müller\nAda\n",
        "Name\nJürg Müller\nAda",
        "\ufeffname;class\r\nJürg Müller;5b\r\n\r\nAda;5b\r\n",
        "Vorname,Nachname,Klasse\nJürg,Müller,5b\nAda,,5b\n",
        "Class\tLast name\tFirst name\n5b\tMüller\tJürg\n5b\t\tAda",
        ' "Jürg  Müller" \nAda',
    ],
)
def test_names_are_read_with_and_without_a_header(text: str) -> None:
    assert read_pupils(text.encode(), "class.csv") == ["Jürg Müller", "Ada"]


def test_a_file_of_an_old_spreadsheet_is_read() -> None:
    assert read_pupils("Name;Klasse\r\nJürg;5b\r\n".encode("cp1252"), "class.csv") == ["Jürg"]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("Anna\nBen\nanna\n", "class.csv: line 3: found 'anna' again, as in line 1"),
        ("", "class.csv: found no names"),
        ("Name\n", "found a header and no names"),
        ("Name,Class\nAda,5b\n,5b\n", "line 3: found no name"),
        ("x" * 61, "at most 60 printable characters"),
        ("\n".join(f"pupil {number}" for number in range(101)), "found 101 names; expected at most 100"),
    ],
)
def test_what_is_wrong_is_said_with_its_line(text: str, reason: str) -> None:
    with pytest.raises(ClassError) as raised:
        read_pupils(text.encode(), "class.csv")
    assert reason in str(raised.value)


def test_names_of_folders_are_plain_and_different() -> None:
    assert folder_name("Jürg Müller-Groß") == "jurg-muller-gross"
    assert folder_name("../..") == "pupil"
    assert folder_name("Zoë", ["zoe", "zoe-2"]) == "zoe-3"
