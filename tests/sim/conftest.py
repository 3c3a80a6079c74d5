"""Turns each measured scene of the chosen set into a test of its own."""

from __future__ import annotations

import pytest

from tests.sim.enki.scenes import SHIPPED, is_set, load


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """A test marked ``enki("prox")`` runs once for each scene of that file that shows no fault of the reference.

    With ``pushed=True`` only where something can be pushed.
    """
    mark = metafunc.definition.get_closest_marker("enki")
    if mark is None:
        return
    folder = metafunc.config.getoption("vectors") or SHIPPED
    if not is_set(folder):
        raise pytest.UsageError(f"--vectors: no file of measured scenes in {folder}")
    scenes = [scene for scene in load(mark.args[0], folder) if not scene.get("artefact")]
    if mark.kwargs.get("pushed"):
        scenes = [scene for scene in scenes if any(thing["mass"] is not None for thing in scene["objects"])]
    metafunc.parametrize("scene", scenes, ids=[scene["id"] for scene in scenes])
