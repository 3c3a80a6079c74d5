"""The class as JUnit XML: one test suite for each submission."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from collections.abc import Sequence

from thymio_sim_ros.grading.reports.texts import number, shown_message, shown_name
from thymio_sim_ros.grading.results import Graded, Verdict

__all__ = ["junit_xml"]

_FAILURES = ("failed",)


def junit_xml(class_: Sequence[Graded]) -> str:
    """The class as JUnit XML. A failed assertion is a failure; a limit or a crash is an error."""
    root = ElementTree.Element("testsuites")
    for graded in class_:
        outcomes = [verdict.outcome for verdict in graded.verdicts]
        counts = {
            "tests": len(outcomes),
            "failures": sum(outcome in _FAILURES for outcome in outcomes),
            "skipped": outcomes.count("skipped"),
        }
        counts["errors"] = counts["tests"] - counts["failures"] - counts["skipped"] - outcomes.count("passed")
        name = shown_name(graded)
        suite = ElementTree.SubElement(root, "testsuite", {"name": name} | {key: str(n) for key, n in counts.items()})
        properties = ElementTree.SubElement(suite, "properties")
        for key, points in {"points": graded.points, "maximum": graded.maximum}.items():
            ElementTree.SubElement(properties, "property", name=key, value=number(points))
        for verdict in graded.verdicts:
            _add_case(suite, name, verdict)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def _add_case(suite: ElementTree.Element, name: str, verdict: Verdict) -> None:
    case = ElementTree.SubElement(
        suite, "testcase", classname=name, name=verdict.test.name, time=f"{verdict.cpu_s:.2f}"
    )
    if verdict.outcome == "passed":
        return
    kind = "skipped" if verdict.outcome == "skipped" else "failure" if verdict.outcome in _FAILURES else "error"
    ElementTree.SubElement(case, kind, message=verdict.outcome).text = shown_message(verdict)
