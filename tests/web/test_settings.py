"""Limits of the page's server."""

from __future__ import annotations

import sys
import types

import pytest

from tests.systems import posix
from thymio_sim_ros.web import settings


def test_without_limits_of_the_system_there_is_a_limit_of_connections(monkeypatch: pytest.MonkeyPatch) -> None:
    folder = types.ModuleType("resource")  # Windows has no such module, and may find a folder of this name
    monkeypatch.setitem(sys.modules, "resource", folder)
    assert settings.max_connections() == 384


@posix
def test_of_few_open_files_the_connections_are_a_part(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("resource.getrlimit", lambda _kind: (100, 100))
    assert settings.max_connections() == 75
