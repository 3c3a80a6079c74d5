"""docs/from-blocks-to-ros.md is true: its programs are those of the page, and all of them avoid things."""

from __future__ import annotations

import importlib.util
import json
import re
import subprocess
from pathlib import Path
from xml.sax.saxutils import escape

import pytest

from tests import pages
from tests.patience import PROGRAM_S
from tests.tracks import assert_avoids
from tests.web_ui.test_skeletons import skeleton
from thymio_sim_ros.device.programs.program import ThymioProgram, load_program
from web_ui import build

ROOT = Path(__file__).parents[1]
PAGE = pages.read("from-blocks-to-ros.md")
FILES = pages.files(PAGE)
BLOCKS = ROOT / "tests" / "data" / "web" / "blockly_samples"
PRINT_VPL = ROOT / "tests" / "web_ui" / "print_samples.js"
PROGRAMS = sorted(name for name in FILES if name.endswith(".aseba"))


def program_of(name: str) -> ThymioProgram:
    """A program of the page, in a file with the event that VPL declares."""
    code = escape(FILES[name])
    return load_program(f'<network><event size="1" name="pair_run"/><node name="thymio">{code}</node></network>', name)


def test_the_page_has_its_programs() -> None:
    names = ["avoid_blocks.aseba", "avoid_scratch.aseba", "avoid_text.aseba", "avoid_vpl.aseba"]
    assert names == PROGRAMS
    assert FILES.keys() - names == {"avoider.py", "test_avoid.py"}


@pytest.mark.parametrize("name", PROGRAMS)
def test_a_program_avoids(name: str) -> None:
    assert_avoids(program_of(name))


def as_shown(text: str) -> str:
    return text.rstrip().replace("\t", "    ") + "\n"


@pytest.mark.parametrize(("name", "sample"), [("avoid_blocks", "avoid"), ("avoid_scratch", "scratch_avoid")])
def test_a_program_of_blocks_is_the_sample(name: str, sample: str) -> None:
    assert FILES[f"{name}.aseba"] == as_shown((BLOCKS / f"{sample}.aseba").read_text(encoding="utf-8"))


def test_the_text_is_what_the_page_offers() -> None:
    assert FILES["avoid_text.aseba"] == as_shown(skeleton("avoid"))


@pytest.mark.process
def test_the_rows_are_the_sample_of_vpl() -> None:
    node = build.find_node()
    if node is None:
        pytest.skip("no Node on this machine")
    done = subprocess.run([node.folder / "node", PRINT_VPL], capture_output=True, text=True, check=True)
    sample = load_program(json.loads(done.stdout)["avoid"], "sample")
    assert program_of("avoid_vpl.aseba").program.words == sample.program.words


@pytest.mark.slow
@pytest.mark.process
def test_the_test_of_the_page_passes(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    if importlib.util.find_spec("rclpy") is None:
        pytest.skip("needs ROS")
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    for name, text in FILES.items():
        (pytester.path / name).write_text(text)
    plugin = ["-p", "thymio_sim_ros.pytest_plugin", "-p", "no:cacheprovider"]
    pytester.runpytest_subprocess(*plugin, "test_avoid.py", timeout=PROGRAM_S).assert_outcomes(passed=2)


def test_every_word_of_the_page_is_on_it() -> None:
    """What the lessons tell pupils to choose has these names."""
    texts = [json.loads(path.read_text()) for path in (ROOT / "aseba_vm" / "languages" / "en").glob("*.json")]
    words = {word for table in texts for word in table.values() if isinstance(word, str)}
    assert set(re.findall(r"\*\*([A-Z?][^*.]+)\*\*", PAGE)) - words == set()
