"""Files of the creator are valid for the simulator: by the published schema, its loader, and its checks."""

from __future__ import annotations

import json
import subprocess
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from thymio_sim_ros.sim.playground import reader as playgrounds
from thymio_sim_ros.sim.playground import writer
from thymio_sim_ros.sim.playground.drawings import drawings
from thymio_sim_ros.sim.playground.reader import PlaygroundError
from web_ui import build

jsonschema = pytest.importorskip("jsonschema")

pytestmark = pytest.mark.process

SCRIPT = Path(__file__).with_name("build_random.js")
PLAYGROUNDS = 40
SCHEMA = Path(__file__).parents[2] / "playgrounds" / "playground.schema.json"


@cache
def cases() -> list[dict[str, Any]]:
    """Random playgrounds built with the creator's modules, and the page's verdict on each."""
    node = build.find_node()
    if node is None:
        pytest.skip("no Node on this machine")
    found: list[dict[str, Any]] = []
    command = [node.folder / "node", SCRIPT, str(PLAYGROUNDS)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        for line in process.stdout:
            printed = json.loads(line)
            if "ask" in printed:
                process.stdin.write(drawings(printed["ask"]) + "\n")
                process.stdin.flush()
            else:
                found.append(printed)
    assert process.returncode == 0
    return found


def read(text: str) -> playgrounds.Playground | None:
    try:
        return playgrounds.loads(text, "built.json")
    except PlaygroundError:
        return None


def test_playgrounds_are_accepted_and_rewritten_unchanged():
    for case in cases()[::4]:
        built = playgrounds.loads(case["text"], "built.json")
        again = playgrounds.loads(writer.dumps(built), "built.json")
        assert (again.shapes, again.robots) == (built.shapes, built.robots)
        names = [item["name"] for key in ("shapes", "robots") for item in json.loads(case["text"])[key]]
        assert [item.name for item in (*built.shapes, *built.robots)] == names
        assert not built.notes, "a robot was put beside the ground"


def test_playgrounds_match_the_published_schema():
    validator = jsonschema.Draft202012Validator(json.loads(SCHEMA.read_text()))
    for case in cases()[::4]:
        validator.validate(json.loads(case["text"]))


def test_page_and_simulator_agree_on_overlaps():
    verdicts = [(case["isFine"], read(case["text"]) is not None) for case in cases()]
    assert [page for page, _ in verdicts] == [simulator for _, simulator in verdicts]
    assert {page for page, _ in verdicts} == {True, False}, "both must come up"
