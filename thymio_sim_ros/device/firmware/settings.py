"""Settings of the robot: 92 words that survive a restart when flashed (docs/spec/thymio-robot.md section 6.3).

Flashed settings are kept in a file, as JSON with the names of their parts, or in memory if there is no file.
"""

from __future__ import annotations

import json
from pathlib import Path

from aseba_vm.cli.output import write_file
from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.sim.audio.synthesis import VOLUME_OFF
from thymio_sim_ros.sim.commands import MotorTargets

__all__ = ["PARTS", "Settings", "SettingsError"]

PARTS: tuple[tuple[str, int, int], ...] = (
    ("sound_shift", 1, 0),
    ("prox_min", 7, 0),
    ("mot256", 2, 256),
    ("prox_ground_max", 2, 0),
    ("spare", 80, 0),
)
"""Name, number of words and initial value of each part, in order of address."""
_MOTORS = 8
"""Address of the first motor's calibration."""
_FULL = 256
_MAX_CORRECTION = 50
_MAX_TARGET = 1000
"""Limits of calibration factors, and of targets before calibration (section 2)."""
INT16 = range(-0x8000, 0x8000)


class SettingsError(ThymioSimError):
    """A file that is not a settings file, or cannot be read; the text is one line."""


class Settings:
    """The current words, and the flashed ones."""

    def __init__(self, file: Path | None = None) -> None:
        """Read the file, if it exists. Raises SettingsError if it is invalid, cannot be read, or is not in a folder."""
        self._file = file
        self._flashed: list[int] = []
        self._words: list[int] = []
        self.reload()

    def __len__(self) -> int:
        return len(self._words)

    def __getitem__(self, address: int) -> int:
        return self._words[address]

    def __setitem__(self, address: int, value: int) -> None:
        self._words[address] = value

    @property
    def volume_shift(self) -> int:
        """Number of bits by which samples are shifted right, 0 to 8."""
        return max(0, min(VOLUME_OFF, self._words[0]))

    def calibrate(self, targets: MotorTargets) -> MotorTargets:
        """Return the targets of the motors: limited, then corrected to (target · mot256) >> 8."""
        left, right = self._words[_MOTORS : _MOTORS + 2]
        if left == right == _FULL:
            return targets
        return MotorTargets(_calibrate(targets.left, left), _calibrate(targets.right, right))

    def flash(self) -> str:
        """Keep the current words for the next restart; return a message if they cannot be stored, else an empty one."""
        self._flashed = list(self._words)
        if self._file is None:
            return ""
        words = iter(self._words)
        parts = {name: [next(words) for _ in range(size)] for name, size, _ in PARTS}
        text = json.dumps(parts, indent=1) + "\n"
        try:
            self._file.parent.mkdir(parents=True, exist_ok=True)
            write_file(str(self._file), text.encode())
        except OSError as error:
            return f"settings are not stored: {self._file}: {error.strerror}"
        return ""

    def reload(self) -> None:
        """Return to the settings of a new robot: those of the file, or the initial values."""
        self._flashed = _initial_values() if self._file is None else _read(self._file)
        self._words = list(self._flashed)

    def restart(self) -> None:
        """Return to the flashed settings."""
        self._words = list(self._flashed)


def _initial_values() -> list[int]:
    return [value for _, size, value in PARTS for _ in range(size)]


def _calibrate(target: int, factor: int) -> int:
    factor = max(_FULL - _MAX_CORRECTION, min(_FULL + _MAX_CORRECTION, factor))
    return max(-_MAX_TARGET, min(_MAX_TARGET, target)) * factor >> 8


def _read(file: Path) -> list[int]:
    try:
        data = json.loads(file.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return _initial_values()
    except NotADirectoryError as error:
        raise SettingsError(
            f"settings {file.parent}: {error.strerror}; expected a folder, or a place for one"
        ) from error
    except OSError as error:
        raise SettingsError(f"settings {file}: {error.strerror}; expected a file that can be read") from error
    except (ValueError, RecursionError) as error:
        raise SettingsError(f"settings {file}: {error}") from error
    words: list[int] = []
    for name, size, _ in PARTS:
        part = data.get(name) if isinstance(data, dict) else None
        if not isinstance(part, list) or len(part) != size or not all(_is_word(word) for word in part):
            raise SettingsError(f"settings {file}: {name}: expected {size} whole numbers from -32768 to 32767")
        words += part
    return words


def _is_word(word: object) -> bool:
    return isinstance(word, int) and not isinstance(word, bool) and word in INT16
