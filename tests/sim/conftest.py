"""Hands the measured scenes of the chosen set to tests."""

from __future__ import annotations

import pytest

from tests.sim.enki.scenes import SHIPPED, is_set, load


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """A test marked ``enki("prox")`` with an argument `scene` runs once for each scene of that file.

    With an argument `scenes` it runs once for all of them. Scenes that show a fault of the reference are left out.
    """
    mark = metafunc.definition.get_closest_marker("enki")
    if mark is None:
        return
    folder = metafunc.config.getoption("vectors") or SHIPPED
    if not is_set(folder):
        raise pytest.UsageError(f"--vectors: no file of measured scenes in {folder}")
    scenes = [scene for scene in load(mark.args[0], folder) if not scene.get("artefact")]
    if "scenes" in metafunc.fixturenames:
        metafunc.parametrize("scenes", [scenes] if scenes else [], ids=lambda _: mark.args[0])
    else:
        metafunc.parametrize("scene", scenes, ids=[scene["id"] for scene in scenes])
