"""Descriptions of sweeps: JSON and TOML say the same, and what is wrong is named."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from thymio_sim_ros.sweep.description import Description, read_description
from thymio_sim_ros.sweep.errors import SweepError

TOML = """
programs = ["pulse.aesl"]
playgrounds = "hall.json"
seeds = 2
seconds = 1
measures = ["x_m", "event.beat"]

[parameters]
SPEED = [100, 200]
motors = "firmware"
playground.box.x_m = [0.5, 0.6]
"""
JSON = {
    "programs": "pulse.aesl",
    "playgrounds": ["hall.json"],
    "seeds": [0, 1],
    "seconds": 1,
    "measures": ["x_m", "event.beat"],
    "parameters": {"SPEED": [100, 200], "motors": ["firmware"], "playground.box.x_m": [0.5, 0.6]},
}


def test_toml_and_json_describe_the_same_sweep(folder: Path) -> None:
    (folder / "sweep.toml").write_text(TOML)
    (folder / "sweep.json").write_text(json.dumps(JSON))
    sweep = read_description(folder / "sweep.toml").sweep()
    assert sweep == read_description(folder / "sweep.json").sweep()
    assert len(sweep) == 8
    assert sweep.run(7).values == (("SPEED", 200), ("motors", "firmware"), ("playground.box.x_m", 0.6))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", "expected a sweep in JSON"),
        ("[]", "found no keys"),
        ('{"seed": 3}', "found the key 'seed', expected some of .*; did you mean 'seeds'?"),
        ('{"seeds": 0}', "seeds: found 0, expected a number of seeds above 0"),
        ('{"seeds": [1, 2, 1]}', "seeds: found 1 twice"),
        ('{"seeds": [1.5]}', r"seeds: found 1\.5, expected a list of integers"),
        ('{"programs": []}', r"programs: found \[\], expected at least one value"),
        ('{"programs": [3]}', "programs: found 3, expected a list of texts"),
        ('{"seconds": -1}', "seconds: found -1, expected 0.01 to"),
        ('{"seconds": "1"}', 'seconds: found "1", expected a number'),
        ('{"limit_s": 0}', "limit_s: found 0, expected seconds of processor time above 0"),
        ('{"parameters": 3}', "parameters: found 3, expected names"),
        ('{"parameters": {"SPEED": [null]}}', "parameters.SPEED: found null, expected a list of numbers"),
        ('{"seeds": 500001, "parameters": {"A": [1, 2]}}', 'sweep: found "1000002 runs", expected at most 1000000'),
    ],
)  # fmt: skip
def test_what_a_file_cannot_say_is_named(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "sweep.json"
    path.write_text(text)
    with pytest.raises(SweepError, match=rf"sweep\.json: .*{message}"):
        read_description(path)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(SweepError, match=r"none\.toml: No such file.*expected a sweep in JSON or TOML"):
        read_description(tmp_path / "none.toml")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"programs": ("explorr",)}, "no program 'explorr'.*did you mean 'explorer'"),
        ({"playgrounds": ("hal",)}, "no playground 'hal'"),
        ({"measures": ("x",)}, "measure: found 'x', expected one of seconds, x_m"),
        ({"measures": ("event.beet",)}, "no program has the event 'beet', .* of beat, other; did you mean 'beat'"),
        ({"measures": ("x_m", "first.n")}, "measure first.n: no program has the event 'n', expected one of beat"),
        ({"measures": ("variable.hist",)}, "has the variable 'hist', expected one of .*history"),
        ({"measures": ("variable.beat",)}, "measure variable.beat: no program has the variable 'beat'"),
        ({"measures": ("variable.history[3]",)}, r"history\[3\]: found index 3, expected one below 3, the size"),
        ({"measures": ("variable.prox.horizontal[7]",)}, "found index 7, expected one below 7"),
        ({"programs": ("explorer",), "measures": ("event.beat",)}, "the event 'beat', expected one of menu.back"),
        ({"parameters": {"SPED": (1,)}}, "SPED: pulse.aesl has no constant or .*; did you mean 'SPEED'"),
        ({"parameters": {"SPEED": (1, 40_000)}}, "SPEED: found 40000, expected an integer from -32768 to 32767"),
        ({"parameters": {"SPEED": (True,)}}, "parameter SPEED: found true, expected an integer"),
        ({"parameters": {"history": (1,)}}, "parameter history: pulse.aesl has an array of 3 words"),
        ({"parameters": {"motors": ("ideal", "fast")}}, 'motors: found "fast", expected one of "ideal", "firmware"'),
        ({"parameters": {"playground.bx.x_m": (1.0,)}}, "playground.bx.x_m: hall.json has no 'bx'; did you mean 'box'"),
        ({"parameters": {"playground.box": (1.0,)}}, "expected a name such as playground.box.x_m"),
        ({"parameters": {"playground.box.x": (1.0,)}}, r"hall.json: shapes\[2\]"),
        ({"parameters": {"playground.box.walls.x_m": (1.0,)}}, "hall.json has no 'walls' there"),
        ({"parameters": {"playground.box.size_x_m": (0.1, -1.0)}}, r"hall.json: shapes\[2\]\.size_x_m"),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_named_before_anything_runs(
    describe: Callable[..., Description], changes: dict[str, object], message: str
) -> None:
    with pytest.raises(SweepError, match=message):
        describe(**changes).sweep()


def test_a_program_with_an_error_is_named(describe: Callable[..., Description], folder: Path) -> None:
    (folder / "bad.aesl").write_text("motor.left.target = x\n")
    with pytest.raises(SweepError, match=r"bad\.aesl: line 1, column 21"):
        describe(programs=("bad.aesl",)).sweep()


def test_a_measure_needs_one_program_that_has_its_name(describe: Callable[..., Description]) -> None:
    measures = ("event.beat", "variable.n", "variable.prox.horizontal[6]", "first.beat")
    assert len(describe(programs=("pulse.aesl", "explorer"), measures=measures).sweep()) == 2
