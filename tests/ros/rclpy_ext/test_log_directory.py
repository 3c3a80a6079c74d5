"""rcl's log files go somewhere else where rcl could not write them."""

from __future__ import annotations

from pathlib import Path

import pytest

from thymio_sim_ros.ros.rclpy_ext import log_directory


@pytest.fixture(autouse=True)
def _temporary(monkeypatch, tmp_path):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))


@pytest.mark.parametrize(
    ("environment", "folder"),
    [
        ({"HOME": "{}/home"}, "home/.ros/log"),
        ({"USERPROFILE": "{}/home"}, "home/.ros/log"),
        ({"HOME": "/proc/nowhere", "ROS_HOME": "{}/ros"}, "ros/log"),
        ({"HOME": "/proc/nowhere", "ROS_HOME": "/proc/nowhere", "ROS_LOG_DIR": "{}/log"}, "log"),
    ],
)
def test_a_choice_that_can_be_written_stays(capsys, tmp_path, environment, folder):
    given = {name: value.format(tmp_path) for name, value in environment.items()}
    found = dict(given)
    log_directory.ensure(found)
    assert found == given
    assert (tmp_path / folder).is_dir()
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize(
    ("environment", "reason"),
    [
        ({}, "HOME is not set"),
        ({"HOME": ""}, "HOME is not set"),
        ({"HOME": "/proc/nowhere"}, "/proc/nowhere/.ros/log: No such file or directory"),
        ({"HOME": "/", "ROS_LOG_DIR": "/dev/null"}, "/dev/null: File exists"),
    ],
)
def test_else_a_temporary_folder_is_taken_and_reported(capsys, tmp_path, environment, reason):
    found = dict(environment)
    log_directory.ensure(found)
    folder = Path(found["ROS_LOG_DIR"])
    assert folder.is_dir()
    assert folder.parent == tmp_path
    reported = f"thymio-sim: log files go to {folder}: {reason}; set ROS_LOG_DIR to choose another\n"
    assert capsys.readouterr().err == reported
