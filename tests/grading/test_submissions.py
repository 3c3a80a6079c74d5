"""Finding of submissions: what learning platforms export, and what is rejected with a reason."""

from __future__ import annotations

import os
import stat
import zipfile
from pathlib import Path

import pytest

from tests.grading.example_class import zipped
from thymio_sim_ros.grading import archives
from thymio_sim_ros.grading.errors import GradingError
from thymio_sim_ros.grading.submissions import Submission, find, prepared


def found(path: Path) -> dict[str, Submission]:
    """Submissions by name."""
    return {submission.name: submission for submission in find(path)}


def test_a_folder_of_folders_files_and_zips(tmp_path: Path) -> None:
    (tmp_path / "anna").mkdir()
    (tmp_path / "anna" / "a.aesl").write_text("1")
    (tmp_path / "ben.aesl").write_text("2")
    (tmp_path / "cleo.zip").write_bytes(zipped({"work/c.aesl": b"3"}))
    (tmp_path / ".DS_Store").write_text("")
    assert {name: dict(one.files) for name, one in found(tmp_path).items()} == {
        "anna": {"a.aesl": b"1"},
        "ben": {"ben.aesl": b"2"},
        "cleo": {"work/c.aesl": b"3"},
    }


def test_a_moodle_export_has_names_numbers_and_zips_in_folders(tmp_path: Path) -> None:
    inner = zipped({"a.aesl": b"2", "__MACOSX/._a.aesl": b""})
    files = {"Anna B_12_assignsubmission_file_/a.aesl": b"1", "Ben_13_assignsubmission_file_/work.zip": inner}
    (tmp_path / "export.zip").write_bytes(zipped(files))
    class_ = found(tmp_path / "export.zip")
    assert {name: (one.identifier, dict(one.files)) for name, one in class_.items()} == {
        "Anna B": ("12", {"a.aesl": b"1"}),
        "Ben": ("13", {"a.aesl": b"2"}),
    }


def test_a_canvas_export_joins_the_files_of_a_pupil(tmp_path: Path) -> None:
    files = {"anna_12_900_a.aesl": b"1", "anna_12_901_map-2.json": b"2", "ben_LATE_13_902_a-1.aesl": b"3"}
    (tmp_path / "export.zip").write_bytes(zipped(files))
    class_ = found(tmp_path / "export.zip")
    assert dict(class_["anna"].files) == {"a.aesl": b"1", "map.json": b"2"}
    assert (class_["ben"].identifier, dict(class_["ben"].files)) == ("13", {"a.aesl": b"3"})


def test_pupils_of_the_same_name_stay_apart(tmp_path: Path) -> None:
    files = {f"Anna_{number}_assignsubmission_file_/a.aesl": b"" for number in (12, 13)}
    (tmp_path / "export.zip").write_bytes(zipped(files))
    assert list(found(tmp_path / "export.zip")) == ["Anna (12)", "Anna (13)"]


@pytest.mark.parametrize("name", ["../evil.aesl", "/etc/evil", "a/../../evil", "C:/evil", "..\\evil"])
def test_a_zip_with_a_path_that_leads_out_is_a_row_with_a_reason(tmp_path: Path, name: str) -> None:
    (tmp_path / "anna.zip").write_bytes(zipped({name: b""}))
    assert "expected paths inside of it" in found(tmp_path)["anna"].problem


def test_links_are_rejected_in_folders_and_zips(tmp_path: Path) -> None:
    (tmp_path / "anna").mkdir()
    (tmp_path / "anna" / "a.aesl").symlink_to("/etc/passwd")
    (tmp_path / "ben").symlink_to("/etc")
    with zipfile.ZipFile(tmp_path / "cleo.zip", "w") as archive:
        entry = zipfile.ZipInfo("a.aesl")
        entry.external_attr = (stat.S_IFLNK | 0o777) << 16
        archive.writestr(entry, "/etc/passwd")
    assert {name: "symbolic link" in one.problem for name, one in found(tmp_path).items()} == dict.fromkeys(
        ("anna", "ben", "cleo"), True
    )


def test_a_pipe_is_rejected_and_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "anna.aesl")
    assert "neither a file nor a folder" in found(tmp_path)["anna"].problem


def test_a_zip_bomb_is_rejected_before_it_is_unpacked(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "anna.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("zeros", bytes(archives.MAX_BYTES + 1))
    assert (tmp_path / "anna.zip").stat().st_size < 20_000
    assert found(tmp_path)["anna"].problem == "more than 8 MB, unpacked"


def test_a_zip_that_lies_about_its_size_is_rejected(tmp_path: Path) -> None:
    data = bytearray(zipped({"a": bytes(1000)}))
    begin = data.index(b"PK\x01\x02") + 24
    data[begin : begin + 4] = (5).to_bytes(4, "little")
    (tmp_path / "anna.zip").write_bytes(data)
    assert "cannot be read" in found(tmp_path)["anna"].problem


@pytest.mark.parametrize("content", [b"", b"no zip", zipped({"a": b"1"})[:-30]])
def test_a_damaged_zip_is_a_row_with_a_reason(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "anna.zip").write_bytes(content)
    assert "cannot be read" in found(tmp_path)["anna"].problem


def test_too_many_files_are_rejected(tmp_path: Path) -> None:
    (tmp_path / "anna.zip").write_bytes(zipped({f"f{number}": b"" for number in range(archives.MAX_FILES + 1)}))
    assert found(tmp_path)["anna"].problem == "more than 300 files"


def test_a_class_that_is_missing_or_empty_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "damaged.zip").write_bytes(b"no zip")
    for path, reported in {"missing": "No such file", "damaged.zip": "cannot be read", ".": "no submissions"}.items():
        if path == ".":
            (tmp_path / "damaged.zip").unlink()
        with pytest.raises(GradingError, match=reported):
            find(tmp_path / path)


@pytest.mark.parametrize(
    ("files", "expected", "names", "problem"),
    [
        ({"f.aesl": b""}, ("f.aesl",), {"f.aesl"}, ""),
        ({"work/f.aesl": b"", "work/m.json": b""}, ("f.aesl",), {"f.aesl", "m.json"}, ""),
        ({"anna final.aesl": b""}, ("f.aesl",), {"f.aesl"}, ""),
        ({"a.aesl": b"", "b.aesl": b""}, ("f.aesl",), {"a.aesl", "b.aesl"}, "no file f.aesl; found a.aesl, b.aesl"),
        ({"a.txt": b""}, ("f.aesl",), {"a.txt"}, "no file f.aesl; found a.txt"),
        ({}, ("f.aesl",), set(), "no file was handed in"),
    ],
)
def test_expected_files_are_found_under_other_names(
    files: dict[str, bytes], expected: tuple[str, ...], names: set[str], problem: str
) -> None:
    result = prepared(Submission("anna", files=files), expected)
    assert (set(result.files), result.problem) == (names, problem)
