"""Reports: content from submissions is only text in them."""

from __future__ import annotations

import csv
import io
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from fractions import Fraction

from thymio_sim_ros.grading.reports.csv_table import csv_table
from thymio_sim_ros.grading.reports.junit import junit_xml
from thymio_sim_ros.grading.reports.page import index_page, submission_page
from thymio_sim_ros.grading.reports.texts import file_name, shown_name
from thymio_sim_ros.grading.results import Graded, GradedTest, Verdict
from thymio_sim_ros.grading.submissions import Submission

TEST = GradedTest("test_a.py::test_it", Fraction(1, 3))
EVIL = "<script>alert(1)</script>\x00\x1b]]>"
GRADED = Graded(
    Submission("=cmd|' /C calc'!A0" + EVIL),
    [Verdict(TEST, "failed", EVIL, EVIL, files={"trace.svg": b"<svg onload='alert(1)'/>"})],
)


def test_the_table_has_no_formulas() -> None:
    row = next(iter(csv.DictReader(io.StringIO(csv_table([GRADED], [TEST])))))
    assert row["name"].startswith("'=cmd")
    assert (row["points"], row["maximum"], row["verdict"]) == ("0", "0.33", "failed")


def test_a_name_is_one_line_that_runs_forward() -> None:
    evil = replace(GRADED, submission=Submission("Anna\n9/9 Ben\u202e\x1b[31m\x9b2J\udcff"))
    assert shown_name(evil) == "Anna\ufffd9/9 Ben\ufffd\ufffd[31m\ufffd2J\ufffd"
    assert len(csv_table([evil], [TEST]).splitlines()) == 2


def test_junit_is_valid_xml_whatever_was_printed() -> None:
    suite = ElementTree.fromstring(junit_xml([GRADED]).encode()).find("testsuite")
    assert suite is not None
    assert "<script>alert(1)</script>\ufffd" in str(suite.findtext("testcase/failure"))


def test_pages_escape_text_and_pictures() -> None:
    for page in (submission_page(GRADED, {}), index_page("class", "none", {"a.html": GRADED})):
        assert "<script" not in page
        assert "onload" not in page


def test_the_reason_of_a_submission_without_points_is_on_its_page_once() -> None:
    verdicts = [Verdict(replace(TEST, name=f"test_a.py::test_{number}"), "not run", "no file") for number in range(3)]
    page = submission_page(Graded(Submission("Anna"), verdicts, "no file"), {})
    assert page.count("no file") == 1
    assert page.count("not run") == 3


def test_names_of_files_depend_on_the_owner_only_and_stay_readable() -> None:
    names = {
        name: file_name(Graded(Submission(name, identifier), []))
        for name, identifier in [
            ("Łukasz Žák", ""), ("Анна Иванова", ""), ("山田 太郎", ""), ("अनीता", ""), ("a b", ""), ("a-b", ""),
            ("\u202e!?", ""), ("x" * 300, ""), ("\U00020000" * 300, ""), ("../..", ""), ("Anna (7)", "7"),
            ("Anna", "8"),
        ]
    }  # fmt: skip
    readable = [name[:-9] for name in names.values()]
    assert readable[:7] == ["Łukasz-Žák", "Анна-Иванова", "山田-太郎", "अनीता", "a-b", "a-b", "submission"]
    assert (readable[9], readable[10], readable[11]) == ("submission", "Anna", "Anna")
    assert len(set(names.values())) == len(names)
    assert all(len(f"{name}.txt".encode()) <= 255 for name in names.values())
    assert names["Anna (7)"] == file_name(Graded(Submission("Anna", "7"), []))  # also before another Anna came
