"""The engine on a real cluster of processes: each task has exactly one outcome, whatever its worker does."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.batch_runs.tasks import FATAL, WRONG, square
from thymio_sim_ros.batch_runs.errors import EngineError
from thymio_sim_ros.batch_runs.failure import Failure

engine = pytest.importorskip("thymio_sim_ros.batch_runs.engine", exc_type=ImportError)

pytestmark = pytest.mark.process


@pytest.fixture(scope="module")
def scheduler() -> Iterator[str]:
    """The address of a scheduler with two workers."""
    with engine._quiet(), engine._local(2, "") as client:
        yield client.scheduler.address


def test_each_task_has_one_outcome_also_beside_tasks_that_raise_or_kill_their_worker(scheduler: str) -> None:
    found = [one for outcomes in engine.run_all(square, range(40), scheduler=scheduler) for one in outcomes]
    assert sorted(number for number, _ in found) == list(range(40))
    outcomes = dict(found)
    assert outcomes.pop(WRONG) == Failure("ValueError: not 13, please")
    assert outcomes.pop(FATAL) == Failure("its process ended each time, without an exception")
    assert outcomes == {number: number * number for number in range(40) if number not in (WRONG, FATAL)}


def test_a_worker_of_another_version_is_an_error(scheduler: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engine, "__version__", "99.0")
    with pytest.raises(EngineError, match=r"a worker has version .* of thymio_sim_ros, expected 99\.0"):
        list(engine.run_all(square, [1], scheduler=scheduler))


def test_a_scheduler_that_is_not_there_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engine, "CONNECT_S", 0.5)
    with pytest.raises(EngineError, match=r"scheduler tcp://127\.0\.0\.1:9: .*expected the address of a running"):
        list(engine.run_all(square, [1], scheduler="tcp://127.0.0.1:9"))
