"""docs/sweeps.md is true: its description, tables and scripts; so is docs/sweep.ipynb."""

from __future__ import annotations

import importlib.util
import json
import re
import shlex
from pathlib import Path
from typing import Any

import pytest

from tests import pages
from thymio_sim_ros.cli import sweep as command
from thymio_sim_ros.cli.main import main
from thymio_sim_ros.sweep.description import Description, read_description
from thymio_sim_ros.sweep.measures import MEASURES
from thymio_sim_ros.sweep.run import run_robots
from thymio_sim_ros.sweep.table import columns

ROOT = Path(__file__).parents[1]
PAGE = pages.read("sweeps.md")
NOTEBOOK = json.loads((ROOT / "docs" / "sweep.ipynb").read_text(encoding="utf-8"))
CELLS = ["".join(cell["source"]) for cell in NOTEBOOK["cells"] if cell["cell_type"] == "code"]


def test_the_description_of_the_page_has_the_runs_and_columns_that_it_shows(tmp_path: Path) -> None:
    (text,) = pages.blocks(PAGE, "toml")
    (tmp_path / "cruise.toml").write_text(text)
    sweep = read_description(tmp_path / "cruise.toml").sweep()
    assert f"= {len(sweep)} runs" in PAGE
    assert "\n" + ",".join(columns(sweep)) + "\n" in PAGE
    shown = re.findall(r"^[0-9a-f]{12},(\d+),.*?,thymio,([\d.]+),([\d.]+),(\d+),(\d+),,$", PAGE, re.MULTILINE)
    assert shown
    (row,) = run_robots(sweep, int(shown[0][0]))
    assert [str(row[name]) for name in sweep.measures] == list(shown[0][1:])


def test_the_command_of_the_page_describes_the_runs_that_it_says() -> None:
    (line,) = pages.blocks(PAGE, "sh")
    program, name, *options = shlex.split(line)
    assert (program, name) == ("thymio-sim", "sweep")
    sweep = command._description(command._parser().parse_args(options)).sweep()
    assert f"{len(sweep)} runs of a\nsimulated minute" in PAGE
    assert ",".join(list(columns(sweep))[:12]) in PAGE


def test_the_tables_name_all_measures_keys_and_options(capsys: pytest.CaptureFixture[str]) -> None:
    assert [name for name in MEASURES if f"`{name}`" not in PAGE] == []
    keys = set(Description.__dataclass_fields__) - {"folder"}
    assert set(re.findall(r"^\| `(\w+)` \| `--", PAGE, re.MULTILINE)) == keys
    with pytest.raises(SystemExit):
        main(["sweep", "--help"])
    known = capsys.readouterr().out
    assert [option for option in re.findall(r"`(--[a-z-]+)", PAGE) if option not in known] == []


def test_the_first_script_prints_a_line_for_each_run(capsys: pytest.CaptureFixture[str]) -> None:
    exec(pages.blocks(PAGE, "python")[0].replace("seconds=5.0", "seconds=0.5"), {"__name__": "script"})
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[:2] for line in lines] == [["100", "1"], ["100", "2"], ["200", "1"], ["200", "2"]]


def test_links_of_the_page_exist() -> None:
    for target in re.findall(r"\]\((?!https?:)([^)#]+)", PAGE):
        assert (ROOT / "docs" / target).is_file(), target


def test_the_notebook_has_one_picture_and_no_failed_cell() -> None:
    assert (NOTEBOOK["nbformat"], NOTEBOOK["metadata"]["kernelspec"]["name"]) == (4, "python3")
    outputs = [output for cell in NOTEBOOK["cells"] for output in cell.get("outputs", ())]
    assert sum("image/png" in output.get("data", {}) for output in outputs) == 1
    assert "error" not in {output["output_type"] for output in outputs}


@pytest.mark.process
def test_the_cells_of_the_notebook_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if importlib.util.find_spec("matplotlib") is None:
        pytest.skip("matplotlib is not installed")
    pytest.importorskip("distributed")
    monkeypatch.setenv("MPLBACKEND", "Agg")
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {"__name__": "notebook"}
    for cell in CELLS:
        exec(cell.replace("SEEDS = 10", "SEEDS = 2").replace("SECONDS = 30", "SECONDS = 0.1"), names)
    assert len(names["rows"]) == 10
