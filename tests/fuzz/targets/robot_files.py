"""Files of a robot: settings, memory card, sounds."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator

from tests.fuzz.target import FOLDER, Target
from thymio_sim_ros.device.firmware import wav
from thymio_sim_ros.device.firmware.sd_card import SdCard
from thymio_sim_ros.device.firmware.settings import PARTS, Settings, SettingsError


def _settings(data: bytes) -> None:
    file = FOLDER / "settings.json"
    file.write_bytes(data)
    settings = Settings(file)
    assert settings.flash() == ""
    assert list(Settings(file)) == list(settings)


def _sound(data: bytes) -> None:
    card = SdCard(FOLDER / "sounds")
    (card.folder / "p1.wav").write_bytes(data)
    found = card.read_sound("p1")
    assert found is not None
    assert found[0] == data[wav.HEADER_BYTES :]


def _card(data: bytes) -> None:
    """Each three bytes are a call of a program, with its argument."""
    folder = FOLDER / "card"
    shutil.rmtree(folder, ignore_errors=True)
    card = SdCard(folder)
    for at in range(0, len(data) - 2, 3):
        number = int.from_bytes(data[at + 1 : at + 3], "little", signed=True)
        match data[at] % 6:
            case 0:
                card.open(number)
            case 1:
                card.write([number] * (number % 9))
            case 2:
                card.read(number % 99)
            case 3:
                card.seek(number)
            case 4:
                card.close()
            case _:
                assert card.write_sound(f"r{number % 3}", b"\x80" * (number % 99))
    assert all(file.parent == folder for file in folder.rglob("*"))
    shutil.rmtree(folder)


def _flashed() -> Iterator[bytes]:
    yield json.dumps({name: [value] * size for name, size, value in PARTS}).encode()


def _sounds() -> Iterator[bytes]:
    card = SdCard(FOLDER / "seed card")
    card.write_sound("r1", bytes(range(100)))
    yield (card.folder / "r1.wav").read_bytes()


TARGETS = (
    Target("settings", _settings, (SettingsError,), _flashed, tuple(f'"{name}"' for name, _, _ in PARTS)),
    Target("sound-file", _sound, (), _sounds, ("RIFF", "WAVE", "fmt ", "data", "LIST")),
    Target("memory-card", _card, (), lambda: [b"\0\1\0\1\7\0\3\0\0\2\7\0\4\0\0\5\x20\0"], (), 96),
)
