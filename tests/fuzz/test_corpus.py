"""Every reader accepts or rejects the kept inputs and some hundred others; campaigns are `python -m tests.fuzz`."""

from __future__ import annotations

import os
import random

import pytest

from tests.fuzz import corpus
from tests.fuzz.mutation import mutated
from tests.fuzz.table import TARGETS
from tests.fuzz.target import HOSTILE, Target

INPUTS = int(os.environ.get("THYMIO_SIM_FUZZ", "100"))
"""Changed inputs of each target."""

OPTIONAL = ("ros-", "tf", "sweep-parquet")
"""Targets that exist only where ROS or pyarrow is installed."""


@pytest.fixture(params=TARGETS.values(), ids=lambda target: target.name)
def target(request: pytest.FixtureRequest) -> Target:
    found: Target = request.param
    return found


def test_every_input_is_accepted_or_rejected(target: Target) -> None:
    seeds = list(target.seeds())
    assert any(target.accepts(data) for data in seeds), "no seed is valid: the target tests nothing"
    inputs = [*seeds, *corpus.load(target.name), *HOSTILE]
    for data in inputs:
        target.accepts(data)
    rng = random.Random(target.name)
    for _ in range(INPUTS):
        data = mutated(rng, inputs, target)
        try:
            target.accepts(data)
        except Exception as error:
            error.add_note(f"input: {data!r}")
            raise


def test_every_file_of_the_corpus_is_that_of_a_target() -> None:
    kept = {path.stem for path in corpus.FOLDER.glob("*.txt")}
    optional = {name for name in kept if name.startswith(OPTIONAL)}
    assert kept - optional <= set(TARGETS)
