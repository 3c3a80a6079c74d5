"""The page of a submission: verdicts, messages, pictures of the paths, and how to open the replay."""

from __future__ import annotations

import base64
import html
from collections.abc import Mapping

from thymio_sim_ros.grading.reports.texts import (
    number,
    pupil_remark,
    short_names,
    shown_message,
    shown_name,
    shown_remark,
)
from thymio_sim_ros.grading.results import Graded, Verdict

__all__ = ["index_page", "submission_page"]

_STYLE = """\
body { font: 16px/1.5 system-ui, sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; color: #1c1c1c }
table { border-collapse: collapse } td, th { padding: .3rem .8rem; text-align: left; border-bottom: 1px solid #ccc }
pre { background: #f3f3f1; padding: .8rem; overflow-x: auto; white-space: pre-wrap } img { max-width: 100% }
.passed { color: #1d6b2c } .lost { color: #a31c1c }
"""
_HEAD = """\
<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title>
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'">
<style>{style}</style></head><body>
<h1>{title}</h1>
"""


def submission_page(graded: Graded, logs: Mapping[str, str]) -> str:
    """The page. `logs`: the run log of a test, as a path beside the page, by the name of the test.

    Everything that comes from a submission is escaped text, or a picture, in which browsers run no scripts.
    """
    names = short_names([verdict.test for verdict in graded.verdicts])
    parts = [_head(shown_name(graded))]
    parts.append(f"<p><b>{number(graded.points)} of {number(graded.maximum)} points</b></p>\n")
    if remark := pupil_remark(graded):
        parts.append(f"<p>{html.escape(remark)}</p>\n")
    parts.append("<table><tr><th>Test</th><th>Verdict</th><th>Points</th></tr>\n")
    parts += [_row(name, verdict) for name, verdict in zip(names, graded.verdicts, strict=True)]
    parts.append("</table>\n")
    for name, verdict in zip(names, graded.verdicts, strict=True):
        if graded.remark and not verdict.files:  # all messages are the remark
            continue
        parts += _details(name, verdict, logs.get(verdict.test.name, ""))
    return "".join([*parts, "</body></html>\n"])


def index_page(title: str, isolation: str, rows: Mapping[str, Graded]) -> str:
    """The page of the class: the points of each submission, by the name of its page."""
    parts = [_head(title), f"<p>Isolation: {html.escape(isolation)}</p>\n"]
    parts.append("<table><tr><th>Name</th><th>Points</th><th>Remark</th></tr>\n")
    for page, graded in rows.items():
        link = f'<a href="{html.escape(page)}">{html.escape(shown_name(graded))}</a>'
        points = f"{number(graded.points)} of {number(graded.maximum)}"
        parts.append(f"<tr><td>{link}</td><td>{points}</td><td>{html.escape(shown_remark(graded))}</td></tr>\n")
    return "".join([*parts, "</table></body></html>\n"])


def _head(title: str) -> str:
    return _HEAD.format(title=html.escape(title), style=_STYLE)


def _row(name: str, verdict: Verdict) -> str:
    kind = "passed" if verdict.outcome == "passed" else "lost"
    points = f"{number(verdict.points)} of {number(verdict.test.points)}"
    outcome = f'<td class="{kind}">{html.escape(verdict.outcome)}</td>'
    return f"<tr><td>{html.escape(name)}</td>{outcome}<td>{points}</td></tr>\n"


def _details(name: str, verdict: Verdict, log: str) -> list[str]:
    message = shown_message(verdict)
    if verdict.test.is_hidden or not (message or verdict.files):
        return []
    parts = [f"<h2>{html.escape(name)}</h2>\n", f"<pre>{html.escape(message)}</pre>\n"]
    if picture := verdict.files.get("trace.svg"):
        source = f"data:image/svg+xml;base64,{base64.b64encode(picture).decode()}"
        parts.append(f'<p><img alt="paths of the robots, seen from above" src="{source}"></p>\n')
    if log:
        command = f"thymio-sim --replay {log}"
        parts.append(f"<p>Watch the run, from shortly before its end: <code>{html.escape(command)}</code></p>\n")
    return parts
