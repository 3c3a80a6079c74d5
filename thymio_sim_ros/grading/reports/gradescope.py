"""A submission as the `results.json` of a Gradescope autograder."""

from __future__ import annotations

import json

from thymio_sim_ros.grading.reports.texts import number, pupil_remark, short_names, shown_message
from thymio_sim_ros.grading.results import Graded

__all__ = ["gradescope_json"]


def gradescope_json(graded: Graded) -> str:
    """The result of one submission. Pupils see hidden tests after the results are published, without messages."""
    names = short_names([verdict.test for verdict in graded.verdicts])
    tests = [
        {
            "name": name,
            "score": float(number(verdict.points)),
            "max_score": float(number(verdict.test.points)),
            "status": "passed" if verdict.outcome == "passed" else "failed",
            "output": "\n".join(filter(None, [verdict.outcome, shown_message(verdict)])),
            "visibility": "after_published" if verdict.test.is_hidden else "visible",
        }
        for name, verdict in zip(names, graded.verdicts, strict=True)
    ]
    result = {"score": float(number(graded.points)), "output": pupil_remark(graded), "tests": tests}
    return json.dumps(result, indent=1, ensure_ascii=False) + "\n"
