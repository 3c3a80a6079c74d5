"""Files of runs: run logs, descriptions and tables of sweeps."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator
from functools import cache
from importlib.util import find_spec

from tests.fuzz.target import FOLDER, Target
from tests.sim.builders import make
from thymio_sim_ros.engine import run_log
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.engine.run_log import RunLog, RunLogError
from thymio_sim_ros.sim.commands import MotorTargets
from thymio_sim_ros.sweep.description import Description, read_description
from thymio_sim_ros.sweep.errors import SweepError
from thymio_sim_ros.sweep.grid import Sweep
from thymio_sim_ros.sweep.run import failed_row
from thymio_sim_ros.sweep.table import read_table, write_table


class _KeptText(io.StringIO):
    """A text that can be read after it has been closed."""

    def close(self) -> None:
        self.text = self.getvalue()
        super().close()


def _log(data: bytes) -> None:
    path = FOLDER / "run.jsonl"
    path.write_bytes(data)
    for _ in run_log.read(path):
        pass
    run_log.made_by(path)


def _description(suffix: str, data: bytes) -> None:
    path = FOLDER / f"sweep{suffix}"
    path.write_bytes(data)
    read_description(path)


@cache
def _sweep() -> Sweep:
    parameters = {"SPEED_STEP": (100, 200), "noise": (True, False)}
    return Description(seconds=2.0, measures=("x_m", "contacts", "fallen"), parameters=parameters).sweep()


def _table(suffix: str, data: bytes) -> None:
    path = FOLDER / f"table{suffix}"
    path.write_bytes(data)
    rows = read_table(path, _sweep())
    write_table(path, _sweep(), rows)  # each value in the type of its column
    typed = read_table(path, _sweep())
    assert list(typed) == list(rows)
    write_table(path, _sweep(), typed)
    assert repr(read_table(path, _sweep())) == repr(typed)


def _logs() -> Iterator[bytes]:
    file = _KeptText()
    log = RunLog(file)
    engine = Engine(make(), seed=3)
    log.begin("fuzz", engine)
    (robot,) = engine.world.robots
    engine.post(robot, MotorTargets(100, 50))
    for _ in range(3):
        engine.step()
    log.close()
    yield file.text.encode()
    first, _, *rest = file.text.splitlines(keepends=True)
    yield "".join((first, *rest)).encode()
    yield (
        first + '{"tick": 250, "spawn": {"name": "late", "x_m": 0.5, "y_m": 0.0}}\n{"tick": 3, "remove": "late"}\n'
    ).encode()
    yield (first + "[" * 3000 + "\n").encode()
    yield (first + '{"tick": 0, "to": "a", "do": "LedLevels", "with": {}}\n{"tick": 1, "reset": true}\n').encode()


def _described() -> Iterator[bytes]:
    yield json.dumps({
        "programs": ["explorer"], "playgrounds": ["obstacle"], "seeds": 3, "seconds": 1.5, "measures": ["x_m"],
        "parameters": {"SPEED": [1, 2.5], "playground.box.x_m": [0.1]}, "limit_s": 10,
    }).encode()  # fmt: skip


def _described_toml() -> Iterator[bytes]:
    yield b'programs = ["a"]\nseeds = [1, 2]\nseconds = 2.0\n[parameters]\nSPEED = [1, 2]\nplayground.b.x_m = [0.1]\n'


def _tables(suffix: str) -> Iterator[bytes]:
    sweep, path = _sweep(), FOLDER / f"seed{suffix}"
    row = failed_row(sweep, 0, 'ValueError: "a", b') | {"x_m": 0.25, "contacts": 3, "fallen": False}
    write_table(path, sweep, {0: [row], 2: [failed_row(sweep, 2, "")]})
    yield path.read_bytes()


KEYS = ('"programs":', '"seeds":', '"seconds":', '"parameters":{', "1e999", "1979-05-27", "[[a]]", "inf", "nan", "0x")
TARGETS = [
    Target("run-log", _log, (RunLogError,), _logs, ('"world":', '"tick":', '"crc":', '"do":', "1e999", "null")),
    Target("sweep-json", lambda data: _description(".json", data), (SweepError,), _described, KEYS),
    Target("sweep-toml", lambda data: _description(".toml", data), (SweepError,), _described_toml, KEYS),
    Target("sweep-csv", lambda data: _table(".csv", data), (SweepError,), lambda: _tables(".csv"), ('"', "\r\n")),
]
if find_spec("pyarrow") is not None:
    TARGETS.append(
        Target(
            "sweep-parquet", lambda data: _table(".parquet", data), (SweepError, OSError), lambda: _tables(".parquet"),
            ("PAR1",), 8192,
        )
    )  # fmt: skip
