"""The command thymio-sim env."""

from __future__ import annotations

import shlex
import sys

import pytest

from thymio_sim_ros import course_packages
from thymio_sim_ros.cli import main

dds_profile = pytest.importorskip("thymio_sim_ros.ros.compat.dds_profile")

PREFIXES = "AMENT_PREFIX_PATH"
PATH = "PYTHONPATH"
CHECKS = "ROS_PYTHON_CHECK_FIELDS"
RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"


@pytest.fixture(autouse=True)
def _unset(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "prefix", str(tmp_path))
    others = ("FASTDDS_DEFAULT_PROFILES_FILE", "RMW_FASTRTPS_USE_QOS_FROM_XML")
    for name in (PATH, PREFIXES, RANGE, CHECKS, dds_profile.VARIABLE, *others):
        monkeypatch.delenv(name, raising=False)


def printed(capsys):
    """The variables that the printed commands set."""
    assert main.main(["env"]) == 0
    words = [shlex.split(line) for line in capsys.readouterr().out.splitlines()]
    assert all(word == "export" for word, _ in words)
    return dict(assignment.split("=", 1) for _, assignment in words)


def test_it_prints_discovery_range_checks_and_profile(capsys):
    found = printed(capsys)
    assert (found[RANGE], found[CHECKS]) == ("LOCALHOST", "1")
    assert found[dds_profile.VARIABLE] == str(dds_profile.ANNOUNCING)
    assert found.keys() == {RANGE, CHECKS, dds_profile.VARIABLE, PATH}


def test_the_packages_of_the_wheels_are_found(capsys, tmp_path):
    (tmp_path / "share" / "ament_index").mkdir(parents=True)
    assert printed(capsys)[PREFIXES] == str(tmp_path)


@pytest.mark.parametrize("name", [RANGE, PREFIXES, CHECKS, dds_profile.VARIABLE])
def test_a_variable_that_is_set_is_left_alone(capsys, monkeypatch, tmp_path, name):
    (tmp_path / "share" / "ament_index").mkdir(parents=True)
    monkeypatch.setenv(name, "theirs")
    assert name not in printed(capsys)


def test_no_profile_is_set_beside_another_one(capsys, monkeypatch):
    monkeypatch.setenv("FASTDDS_DEFAULT_PROFILES_FILE", "theirs")
    assert dds_profile.VARIABLE not in printed(capsys)


def test_the_path_of_imports_gets_one_folder_once(capsys, monkeypatch):
    monkeypatch.setenv(PATH, "theirs:here")
    path = printed(capsys)[PATH]
    assert path == f"{course_packages.STARTUP}:theirs:here"
    monkeypatch.setenv(PATH, path)
    assert PATH not in printed(capsys)
