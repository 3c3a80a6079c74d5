"""Settings: 92 words by address, kept when flashed, and what they mean."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests import disk
from tests.systems import posix
from thymio_sim_ros.device.firmware.settings import PARTS, Settings, SettingsError
from thymio_sim_ros.sim.commands import MotorTargets


def test_there_are_92_words() -> None:
    settings = Settings()
    assert len(settings) == sum(size for _, size, _ in PARTS) == 92
    assert [settings[address] for address in range(12)] == [0] * 8 + [256, 256, 0, 0]


def test_what_was_not_flashed_is_lost_in_a_restart() -> None:
    settings = Settings()
    for kept in (0, 3):
        for word in (4, 5):
            settings[0] = word
            settings.restart()
            assert settings[0] == kept
        settings[0] = 3
        assert settings.flash() == ""


def test_flashed_settings_are_kept_in_a_file(tmp_path: Path) -> None:
    file = tmp_path / "robot" / "settings.json"
    settings = Settings(file)
    settings[0], settings[8], settings[91] = 2, 260, -1
    settings.flash()
    assert json.loads(file.read_text())["mot256"] == [260, 256]
    again = Settings(file)
    assert [again[address] for address in range(92)] == [settings[address] for address in range(92)]


def test_a_new_robot_has_the_settings_of_the_file_or_the_initial_values(tmp_path: Path) -> None:
    for settings, kept in ((Settings(), 0), (Settings(tmp_path / "settings.json"), 2)):
        settings[0] = 2
        settings.flash()
        settings[0] = 3
        settings.reload()
        assert settings[0] == kept


def test_nothing_is_stored_without_flash(tmp_path: Path) -> None:
    file = tmp_path / "settings.json"
    settings = Settings(file)
    settings[0] = 2
    assert not file.exists()


@posix
def test_settings_outlive_a_disk_that_is_full(tmp_path: Path) -> None:
    file = tmp_path / "settings.json"
    settings = Settings(file)
    settings[0] = 2
    settings.flash()
    settings[0] = 3
    with disk.files_end_at(100):
        assert settings.flash() == f"settings are not stored: {file}: {disk.FILE_TOO_LARGE}"
    assert Settings(file)[0] == 2
    assert list(tmp_path.iterdir()) == [file]


def test_a_file_that_cannot_be_written_is_reported(tmp_path: Path) -> None:
    (tmp_path / "robot").touch()
    settings = Settings()
    settings._file = tmp_path / "robot" / "settings.json"
    assert "settings are not stored" in settings.flash()


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("{", "settings.json: "),
        ("[]", "sound_shift: expected 1 whole numbers"),
        ('{"sound_shift": [1, 2]}', "sound_shift: expected 1 whole numbers"),
        ('{"sound_shift": [0], "prox_min": [0, 0, 0, 0, 0, 0, 70000]}', "prox_min: expected 7 whole numbers"),
        ('{"sound_shift": [true]}', "sound_shift: expected 1 whole numbers"),
    ],
)
def test_a_file_that_holds_something_else_is_refused(tmp_path: Path, text: str, found: str) -> None:
    file = tmp_path / "settings.json"
    file.write_text(text)
    with pytest.raises(SettingsError, match=found):
        Settings(file)


@pytest.mark.parametrize(("word", "shift"), [(0, 0), (5, 5), (8, 8), (9, 8), (-1, 0)])
def test_the_volume_is_a_shift_of_0_to_8(word: int, shift: int) -> None:
    settings = Settings()
    settings[0] = word
    assert settings.volume_shift == shift


@pytest.mark.parametrize(
    ("targets", "factors", "calibrated"),
    [
        ((300, -300), (256, 256), (300, -300)),
        ((2000, -2000), (256, 256), (2000, -2000)),
        ((300, -300), (266, 246), (311, -289)),
        ((300, 300), (1000, 0), (358, 241)),
        ((2000, -2000), (257, 257), (1003, -1004)),
    ],
)
def test_targets_are_corrected_by_the_calibration(
    targets: tuple[int, int], factors: tuple[int, int], calibrated: tuple[int, int]
) -> None:
    settings = Settings()
    settings[8], settings[9] = factors
    assert settings.calibrate(MotorTargets(*targets)) == MotorTargets(*calibrated)
