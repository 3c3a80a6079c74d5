"""Proximity sensors read what the reference reads, in its mode."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from tests.sim.enki.scenes import Scene, world_of

GRAZE_M = 1e-9
"""Rounding decides if a ray meets what it grazes, or what is just in range; with so much more or less, it is clear."""


@pytest.mark.enki("prox")
def test_every_scene_reads_as_measured_in_enki_mode(scenes: tuple[Scene, ...]) -> None:
    """Scenes without walls around them are places of one world, those with walls are places of another."""
    inside = [scene for scene in scenes if scene["world"]["kind"] == "square"]
    outside = [scene for scene in scenes if scene["world"]["kind"] != "square"]
    wrong = _wrong(inside) | _wrong(outside)
    assert not wrong, "\n".join(f"{name}: found {found}, expected {counts}" for name, (found, counts) in wrong.items())


def _wrong(scenes: Sequence[Scene]) -> dict[str, tuple[list[int], list[float]]]:
    """The counts found and expected of the scenes that differ, also with all things grown or shrunk a little, by id."""
    found = _different(scenes, 0.0)
    grown = _different([scene for scene in scenes if scene["id"] in found], GRAZE_M)
    shrunk = _different([scene for scene in scenes if scene["id"] in grown], -GRAZE_M)
    return {name: found[name] for name in shrunk}


def _different(scenes: Sequence[Scene], grown_m: float) -> dict[str, tuple[list[int], list[float]]]:
    """The counts found and expected of the scenes that differ with all things grown, by id."""
    return {
        scene["id"]: (counts, scene["noiseless"])
        for scene, counts in zip(scenes, _read(scenes, grown_m), strict=True)
        if counts != pytest.approx(scene["noiseless"], abs=2)
    }


def _read(scenes: Sequence[Scene], grown_m: float) -> list[list[int]]:
    """The counts without noise of the first robot of each scene."""
    grown = [{**scene, "objects": [_grown(thing, grown_m) for thing in scene["objects"]]} for scene in scenes]
    options = {"proximity_model": "enki", "periods_ns": {"proximity": 10_000_000}}
    found = {robot: reading.words for robot, _, reading in world_of(grown, noise=False, **options).step().readings}
    return [list(found[f"robot{number}_0"]) for number in range(len(scenes))]


def _grown(thing: Scene, grown_m: float) -> Scene:
    return {**thing, **{size: thing[size] + grown_m for size in ("radius", "size_x", "size_y") if size in thing}}
