"""Proximity sensors read what the reference reads, in its mode."""

from __future__ import annotations

import pytest

from tests.sim.builders import measure_one
from tests.sim.enki.scenes import Scene, world_of

GRAZE_M = 1e-9
"""Rounding decides if a ray meets what it grazes, or what is just in range; with so much more or less, it is clear."""


@pytest.mark.enki("prox")
def test_a_scene_reads_as_measured_in_enki_mode(scene: Scene) -> None:
    found = [_read(scene, grown_m) for grown_m in (0.0, GRAZE_M, -GRAZE_M)]
    expected = pytest.approx(scene["noiseless"], abs=2)
    assert any(words == expected for words in found), (found[0], scene["noiseless"])


def _read(scene: Scene, grown_m: float) -> tuple[int, ...]:
    """The counts without noise, all things grown by a little."""
    things = [
        {**thing, **{size: thing[size] + grown_m for size in ("radius", "size_x", "size_y") if size in thing}}
        for thing in scene["objects"]
    ]
    options = {"proximity_model": "enki", "periods_ns": {"proximity": 10_000_000}}
    words: tuple[int, ...] = measure_one(
        world_of({**scene, "objects": things}, noise=False, **options), "proximity"
    ).words
    return words
