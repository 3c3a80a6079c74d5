"""The runs of a sweep: their order, and the fingerprint of all that determines them."""

from __future__ import annotations

from dataclasses import replace

from thymio_sim_ros.sweep.grid import Source, Sweep

SWEEP = Sweep(
    programs=(Source("p", "1"), Source("q", "2")),
    playgrounds=(Source("a", "3"), Source("b", "4")),
    parameters=(("x", (1, 2, 3)), ("y", (0.5, 1.5))),
    seeds=(10, 20),
    seconds=1.0,
    measures=("x_m",),
    limit_s=1.0,
)


def test_each_combination_is_one_run() -> None:
    runs = [SWEEP.run(number) for number in range(len(SWEEP))]
    seen = {(run.program.name, run.playground.name, run.values, run.seed) for run in runs}
    assert len(seen) == len(runs) == 2 * 2 * 3 * 2 * 2


def test_the_seed_varies_fastest_then_the_last_parameter() -> None:
    found = [(run.values, run.seed) for run in map(SWEEP.run, range(5))]
    assert found == [
        ((("x", 1), ("y", 0.5)), 10),
        ((("x", 1), ("y", 0.5)), 20),
        ((("x", 1), ("y", 1.5)), 10),
        ((("x", 1), ("y", 1.5)), 20),
        ((("x", 2), ("y", 0.5)), 10),
    ]
    last = SWEEP.run(len(SWEEP) - 1)
    assert (last.program.name, last.playground.name) == ("q", "b")


def test_the_fingerprint_is_that_of_the_content() -> None:
    assert replace(SWEEP).fingerprint == SWEEP.fingerprint
    others = [
        replace(SWEEP, seeds=(10, 21)),
        replace(SWEEP, seconds=2.0),
        replace(SWEEP, programs=(Source("p", "1"), Source("q", "other text"))),
        replace(SWEEP, parameters=(("x", (1, 2, 3)), ("y", (0.5, 1.5001)))),
    ]
    assert len({SWEEP.fingerprint, *(other.fingerprint for other in others)}) == 1 + len(others)
