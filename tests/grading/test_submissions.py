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
from thymio_sim_ros.grading.reports.texts import file_name
from thymio_sim_ros.grading.results import Graded
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


def test_a_moodle_export_without_folders_has_names_and_numbers(tmp_path: Path) -> None:
    files = {"Anna B_12_assignsubmission_file_my_a.aesl": b"1", "Anna B_12_assignsubmission_file_map.json": b"2"}
    (tmp_path / "export.zip").write_bytes(zipped(files))
    (submission,) = find(tmp_path / "export.zip")
    assert (submission.name, submission.identifier) == ("Anna B", "12")
    assert dict(submission.files) == {"my_a.aesl": b"1", "map.json": b"2"}


@pytest.mark.parametrize("is_zip", [True, False])
def test_of_files_that_were_handed_in_again_the_last_one_counts(tmp_path: Path, is_zip: bool) -> None:
    files = {"anna_12_1000_a-1.aesl": b"new", "anna_12_999_a.aesl": b"old", "anna_12_998_b.json": b"same"}
    (tmp_path / "export.zip").write_bytes(zipped({**files, "anna_12_1001_b-1.json": b"same"}))
    if not is_zip:
        with zipfile.ZipFile(tmp_path / "export.zip") as archive:
            archive.extractall(tmp_path / "unpacked")
    (submission,) = find(tmp_path / ("export.zip" if is_zip else "unpacked"))
    assert dict(submission.files) == {"a.aesl": b"new", "b.json": b"same"}
    assert submission.notes == ("a.aesl was handed in more than once: the last one was graded",)


def test_files_of_the_same_name_are_graded_as_those_of_one_pupil_with_a_remark(tmp_path: Path) -> None:
    (tmp_path / "Anna.aesl").write_text("1")
    (tmp_path / "Anna.zip").write_bytes(zipped({"b.aesl": b"2"}))
    (submission,) = find(tmp_path)
    assert submission.files.keys() == {"Anna.aesl", "b.aesl"}
    assert submission.notes == ("several files or folders have the name Anna: they were graded as those of one pupil",)


def test_a_canvas_export_joins_the_files_of_a_pupil(tmp_path: Path) -> None:
    files = {"anna_12_900_a.aesl": b"1", "anna_12_901_map-2.json": b"2", "ben_LATE_13_902_a-1.aesl": b"3"}
    (tmp_path / "export.zip").write_bytes(zipped(files))
    class_ = found(tmp_path / "export.zip")
    assert dict(class_["anna"].files) == {"a.aesl": b"1", "map.json": b"2"}
    assert (class_["ben"].identifier, dict(class_["ben"].files)) == ("13", {"a.aesl": b"3"})


METADATA = b"""---
submission_900:
  :submitters:
  - :name: Anna
    :sid: '1'
  :created_at: 2026-11-01 10:00:00.5 Z
submission_901:
  :submitters:
  - :name: Ben
  - :name: Cleo
"""


@pytest.mark.parametrize("folder", ["", "assignment_77_export/"])
def test_a_gradescope_export_has_the_names_of_its_metadata(tmp_path: Path, folder: str) -> None:
    files = {f"submission_{number}/a.aesl": b"" for number in (900, 901, 902)}
    files = {folder + name: data for name, data in ({"submission_metadata.yml": METADATA} | files).items()}
    (tmp_path / "export.zip").write_bytes(zipped(files))
    with zipfile.ZipFile(tmp_path / "export.zip") as archive:
        archive.extractall(tmp_path / "unpacked")
    for path in (tmp_path / "export.zip", tmp_path / "unpacked" / folder):
        assert {name: one.identifier for name, one in found(path).items()} == {
            "Anna": "900",
            "Ben and Cleo": "901",
            "submission_902": "902",
        }


def test_a_pupil_of_gradescope_who_hands_in_again_keeps_the_page(tmp_path: Path) -> None:
    pages = []
    for number, sid in (
        (900, ":sid: '1'"),
        (950, ":sid: '1'"),
        (950, ":sid: '2'"),
        (950, ":email: a@b"),
        (960, "a: b"),
    ):
        metadata = f"submission_{number}:\n  :submitters:\n  - :name: Anna\n    {sid}\n"
        files = {"submission_metadata.yml": metadata.encode(), f"submission_{number}/a.aesl": b""}
        (tmp_path / "export.zip").write_bytes(zipped(files))
        (submission,) = find(tmp_path / "export.zip")
        assert submission.identifier == str(number)
        pages.append(file_name(Graded(submission, [])))
    assert pages[0] == pages[1]
    assert len(set(pages)) == 4


def test_two_submissions_of_one_pupil_of_gradescope_have_two_pages(tmp_path: Path) -> None:
    entry = "  :submitters:\n  - :name: Anna\n    :sid: '1'\n"
    files = {"submission_metadata.yml": f"submission_7:\n{entry}submission_8:\n{entry}".encode()}
    files |= {f"submission_{number}/a.aesl": b"" for number in (7, 8)}
    (tmp_path / "export.zip").write_bytes(zipped(files))
    submissions = find(tmp_path / "export.zip")
    assert [one.name for one in submissions] == ["Anna (7)", "Anna (8)"]
    assert len({file_name(Graded(one, [])) for one in submissions}) == 2


@pytest.mark.parametrize("metadata", [b"", b"a: [", b"- 1", b"submission_900: {':submitters': 3}", b"\xff\xfe", b"!!x"])
def test_a_gradescope_export_without_names_has_numbers(tmp_path: Path, metadata: bytes) -> None:
    files = {"submission_metadata.yml": metadata, "submission_900/a.aesl": b""}
    (tmp_path / "export.zip").write_bytes(zipped(files))
    assert list(found(tmp_path / "export.zip")) == ["submission_900"]


def test_what_systems_and_tools_add_does_not_count(tmp_path: Path) -> None:
    clutter = {f".git/objects/{number}": b"" for number in range(archives.MAX_FILES + 1)} | {".DS_Store": b""}
    for name, data in ({"anna/work.zip": zipped({"a.aesl": b"1"} | clutter), "ben/b.aesl": b"2"}).items():
        for path, content in {name: data, **{f"{name.partition('/')[0]}/{more}": b"" for more in clutter}}.items():
            (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / path).write_bytes(content)
    (tmp_path / "ben" / ".venv").symlink_to("/usr")
    assert {name: dict(one.files) for name, one in found(tmp_path).items()} == {
        "anna": {"a.aesl": b"1"},
        "ben": {"b.aesl": b"2"},
    }


def test_a_rejected_file_in_a_zip_of_the_class_costs_its_own_submission_only(tmp_path: Path) -> None:
    files = {"anna/a.aesl": b"1", "ben/big": bytes(archives.MAX_BYTES + 1), "dora/../../evil": b"", "eve/e": b"2"}
    with zipfile.ZipFile(tmp_path / "class.zip", "w") as archive:
        link = zipfile.ZipInfo("cleo/a.aesl")
        link.external_attr = (stat.S_IFLNK | 0o777) << 16
        archive.writestr(link, "/etc/passwd")
        for name, content in files.items():
            archive.writestr(name, content)
    assert {name: one.problem for name, one in found(tmp_path / "class.zip").items()} == {
        "anna": "",
        "ben": "more than 8 MB, unpacked: hand in only what the task asks for",
        "cleo": "cleo/a.aesl is a link (symbolic link) to something else: hand in the file or folder itself",
        "dora": "'dora/../../evil' leads out of the zip: pack the folder of your work again",
        "eve": "",
    }


def test_a_pupil_without_a_file_is_not_forgotten(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "class.zip", "w") as archive:
        for name in (
            "class/",
            "class/anna/",
            "class/ben/.keep",
            "class/cleo/c.aesl",
            "__MACOSX/class/dora/x",
            ".DS_Store",
        ):
            archive.writestr(name, "")
    assert {name: set(one.files) for name, one in found(tmp_path / "class.zip").items()} == {
        "anna": set(),
        "ben": set(),
        "cleo": {"c.aesl"},
    }


def test_an_encrypted_zip_is_a_row_with_a_reason(tmp_path: Path) -> None:
    data = bytearray(zipped({"a.aesl": b"1"}))
    data[data.index(b"PK\x01\x02") + 8] |= 1
    (tmp_path / "anna.zip").write_bytes(data)
    assert found(tmp_path)["anna"].problem == "a.aesl has a password: pack a zip without a password"


def test_names_of_a_mac_are_read_as_they_were_written(tmp_path: Path) -> None:
    data = zipped({"class/Zoe\u0308/lo\u0308sung.py": b"1"})  # decomposed, in UTF-8
    unflagged = bytearray(data)
    for flags in (7, data.index(b"PK\x01\x02") + 9):
        unflagged[flags] &= ~0x08  # macOS does not say that it is UTF-8
    for name, content in {"flagged": data, "unflagged": bytes(unflagged)}.items():
        (tmp_path / f"{name}.zip").write_bytes(content)
        assert {who: dict(one.files) for who, one in found(tmp_path / f"{name}.zip").items()} == {
            "Zo\u00eb": {"l\u00f6sung.py": b"1"}
        }


def test_pupils_of_the_same_name_stay_apart(tmp_path: Path) -> None:
    files = {f"Anna_{number}_assignsubmission_file_/a.aesl": b"" for number in (12, 13)}
    (tmp_path / "export.zip").write_bytes(zipped(files))
    assert list(found(tmp_path / "export.zip")) == ["Anna (12)", "Anna (13)"]


@pytest.mark.parametrize("name", ["../evil.aesl", "/etc/evil", "a/../../evil", "C:/evil", "..\\evil"])
def test_a_zip_with_a_path_that_leads_out_is_a_row_with_a_reason(tmp_path: Path, name: str) -> None:
    (tmp_path / "anna.zip").write_bytes(zipped({name: b""}))
    assert "leads out of the zip" in found(tmp_path)["anna"].problem


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
    assert found(tmp_path)["anna"].problem == "more than 8 MB, unpacked: hand in only what the task asks for"


def test_a_zip_that_lies_about_its_size_is_rejected(tmp_path: Path) -> None:
    data = bytearray(zipped({"a": bytes(1000)}))
    begin = data.index(b"PK\x01\x02") + 24
    data[begin : begin + 4] = (5).to_bytes(4, "little")
    (tmp_path / "anna.zip").write_bytes(data)
    assert "cannot be read" in found(tmp_path)["anna"].problem


@pytest.mark.parametrize("content", [b"", b"no zip", zipped({"a": b"1"})[:-30]], ids=["empty", "text", "cut off"])
def test_a_damaged_zip_is_a_row_with_a_reason(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "anna.zip").write_bytes(content)
    assert "cannot be read" in found(tmp_path)["anna"].problem


def test_too_many_files_are_rejected(tmp_path: Path) -> None:
    (tmp_path / "anna.zip").write_bytes(zipped({f"f{number}": b"" for number in range(archives.MAX_FILES + 1)}))
    assert found(tmp_path)["anna"].problem == "more than 300 files: hand in only what the task asks for"


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
        (
            {"a.aesl": b"", "b.aesl": b""},
            ("f.aesl",),
            {"a.aesl", "b.aesl"},
            "no file f.aesl: hand in one file with this name; found a.aesl, b.aesl",
        ),
        ({"a.txt": b""}, ("f.aesl",), {"a.txt"}, "no file f.aesl: hand in one file with this name; found a.txt"),
        (
            {"p/setup.py": b"", "p/p/f.py": b"", "p/p/g.py": b""},
            ("f.py",),
            {"setup.py", "p/f.py", "p/g.py", "f.py", "g.py"},
            "",
        ),
        (
            {"r.txt": b"", "a/f.py": b"", "b/f.py": b""},
            ("f.py",),
            {"r.txt", "a/f.py", "b/f.py"},
            "no file f.py: hand in one file with this name; found a/f.py, b/f.py, r.txt",
        ),
        ({"F.AESL": b""}, ("f.aesl",), {"f.aesl"}, ""),
        ({"work.zip": zipped({"w/f.aesl": b""}), "w/notes.pdf": b""}, ("f.aesl",), {"f.aesl", "notes.pdf"}, ""),
        ({"f.aesl": b"", "old.zip": b"no zip"}, ("f.aesl",), {"f.aesl", "old.zip"}, ""),
        ({"x" * 256 + "/f.aesl": b""}, ("f.aesl",), {"f.aesl"}, ""),
        (
            {"f.aesl": b"", "a": b"", "a/b": b""},
            ("f.aesl",),
            {"f.aesl", "a", "a/b"},
            "a is both a file and a folder: give one of them another name",
        ),
        ({}, ("f.aesl",), set(), "no file was handed in: hand in f.aesl"),
    ],
)
def test_expected_files_are_found_under_other_names(
    files: dict[str, bytes], expected: tuple[str, ...], names: set[str], problem: str
) -> None:
    result = prepared(Submission("anna", files=files), expected)
    assert (set(result.files), result.problem) == (names, problem)


@pytest.mark.parametrize(
    "name",
    [
        "follower.aesl.txt",
        "follower (1).aesl",
        "follower(2).aesl",
        "follower (1) (1).aesl",
        "follower - Copy.aesl",
        "follower - Kopie (2).aesl",
        "follower - Copie.aesl",
        "follower copia 2.aesl",
        "Kopie von follower.aesl",
        "Copy of follower.aesl",
        "Copie de follower.aesl",
        "Copia di Kopie von follower.aesl",
        "follower.aesl.download",
        "follower (1).aesl.txt",
        "Follower.AESL",
        "follower.aesl (1)",
        "follower-1.aesl",
        "follower.aesl.aesl",
        "folder/follower (1).aesl",
    ],
)
def test_the_name_of_a_copy_is_found_with_a_remark(name: str) -> None:
    """Beside another program, so that the name decides and not the suffix."""
    result = prepared(Submission("anna", files={name: b"a", "wall.aesl": b"b"}), ["follower.aesl"])
    assert (result.problem, result.files.get("follower.aesl")) == ("", b"a")
    assert result.notes == (f"{name} was graded as follower.aesl",)


def test_a_copy_beside_the_expected_file_is_remarked() -> None:
    files = {"follower.aesl": b"old", "follower (1).aesl": b"new"}
    result = prepared(Submission("anna", files=files), ["follower.aesl"])
    assert result.notes == ("follower (1).aesl was not graded, but follower.aesl",)


def test_copies_that_differ_are_not_chosen_from() -> None:
    files = {"follower (1).aesl": b"1", "follower (2).aesl": b"2"}
    problem = prepared(Submission("anna", files=files), ["follower.aesl"]).problem
    assert (
        problem == "no file follower.aesl: hand in one file with this name; found follower (1).aesl, follower (2).aesl"
    )


def test_another_number_is_another_file() -> None:
    files = {"level_1.aesl": b"1", "level_2.aesl": b"2", "level_1 (1).aesl": b"3"}
    result = prepared(Submission("anna", files=files), ["level_1.aesl"])
    assert result.notes == ("level_1 (1).aesl was not graded, but level_1.aesl",)
    assert prepared(Submission("anna", files={"level_2.aesl": b"", "x.aesl": b""}), ["level_1.aesl"]).problem


@pytest.mark.parametrize("name", ["level 2.aesl", "level2.aesl", "task (a).aesl"])
def test_an_expected_name_may_look_like_a_copy(name: str) -> None:
    files = {name: b"right", "other.aesl": b""}
    assert prepared(Submission("anna", files=files), [name]).files[name] == b"right"


@pytest.mark.process
def test_blocks_are_converted(scratch_project: bytes) -> None:
    files = {"follower (1).sb3": scratch_project, "readme.txt": b""}
    result = prepared(Submission("anna", files=files), ["follower.aesl"])
    assert result.problem == ""
    assert b"motor.left.target = 0" in result.files["follower.aesl"]
    assert result.notes == (
        "the blocks of follower (1).sb3 were graded as follower.aesl",
        "follower (1).sb3: left out: looks_sayforsecs (1 times)",
    )
