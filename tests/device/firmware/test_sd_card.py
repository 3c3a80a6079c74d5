"""A folder as the memory card: data files by number, sounds, nothing outside."""

from __future__ import annotations

import os
import wave
from pathlib import Path

import pytest

from tests.systems import links, posix
from thymio_sim_ros.device.firmware import sd_card as cards
from thymio_sim_ros.device.firmware.sd_card import SdCard, SdCardError


@pytest.fixture
def card(tmp_path: Path) -> SdCard:
    return SdCard(tmp_path / "card")


def sound(path: Path, samples: bytes, *, bits: int = 8, channels: int = 1, rate: int = 7812) -> None:
    with wave.open(str(path), "wb") as file:
        file.setnchannels(channels)
        file.setsampwidth(bits // 8)
        file.setframerate(rate)
        file.writeframes(samples)


def test_words_come_back_in_order_and_little_endian(card: SdCard) -> None:
    assert card.open(3)
    assert card.write([1, -2, 32767, -32768]) == 4
    assert card.seek(1)
    assert card.read(10) == [-2, 32767, -32768]
    assert (card.folder / "u3.dat").read_bytes() == b"\x01\x00\xfe\xff\xff\x7f\x00\x80"


def test_a_file_keeps_its_words_and_opens_at_its_beginning(card: SdCard) -> None:
    card.open(1)
    card.write([7, 8, 9])
    card.close()
    assert card.read(1) == []
    assert card.open(1)
    assert card.read(2) == [7, 8]


def test_writing_replaces_what_lies_there_and_no_more(card: SdCard) -> None:
    card.open(1)
    card.write([1, 2, 3])
    card.seek(1)
    card.write([20])
    card.seek(0)
    assert card.read(3) == [1, 20, 3]


def test_what_lies_between_is_zero(card: SdCard) -> None:
    card.open(1)
    assert card.seek(3)
    assert card.read(1) == []
    assert card.write([5]) == 1
    card.seek(0)
    assert card.read(9) == [0, 0, 0, 5]


def test_opening_another_file_closes_the_first(card: SdCard) -> None:
    card.open(1)
    card.write([1])
    card.open(2)
    assert card.read(1) == []


def test_a_file_that_cannot_be_opened_closes_the_first_too(card: SdCard) -> None:
    card.open(1)
    (card.folder / "u2.dat").mkdir()
    assert not card.open(2)
    assert card.write([1]) == 0


def test_without_an_open_file_nothing_is_done(card: SdCard) -> None:
    assert (card.write([1]), card.read(1), card.seek(0)) == (0, [], False)


@pytest.mark.parametrize("number", [-1, -7])
def test_a_negative_number_is_no_file(card: SdCard, number: int) -> None:
    assert not card.open(number)
    assert list(card.folder.iterdir()) == []


def test_half_a_word_at_the_end_is_not_read(card: SdCard) -> None:
    (card.folder / "u1.dat").write_bytes(b"\x01\x00\x02")
    card.open(1)
    assert card.read(2) == [1]
    assert card.write([3]) == 1
    assert (card.folder / "u1.dat").read_bytes() == b"\x01\x00\x03\x00"


def test_names_are_found_in_any_case(card: SdCard) -> None:
    (card.folder / "U5.DAT").write_bytes(b"\x09\x00")
    card.open(5)
    assert card.read(1) == [9]


@links
def test_a_link_to_the_outside_is_not_followed(card: SdCard, tmp_path: Path) -> None:
    secret = tmp_path / "secret"
    secret.write_bytes(b"\x01\x00")
    os.symlink(secret, card.folder / "u1.dat")
    os.symlink(tmp_path / "new.wav", card.folder / "r1.wav")
    assert not card.open(1)
    assert not card.write_sound("r1", b"abc")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["card", "secret"]


def test_a_folder_in_place_of_a_file_cannot_be_opened(card: SdCard) -> None:
    (card.folder / "u1.dat").mkdir()
    assert not card.open(1)


def test_a_file_that_is_full_takes_no_more(card: SdCard, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cards, "MAX_BYTES", 6)
    card.open(1)
    assert card.write([1, 2]) == 2
    assert card.write([3, 4]) == 1
    assert card.write([5]) == 0
    card.seek(4)
    assert card.write([6, 7]) == 0


def test_a_record_comes_back_as_it_was(card: SdCard) -> None:
    samples = bytes(range(256))
    assert card.write_sound("r1", samples)
    assert card.read_sound("r1") == (samples, "")
    assert (card.folder / "r1.wav").stat().st_size == 44 + 256


def test_a_sound_that_is_missing_is_none(card: SdCard) -> None:
    assert card.read_sound("p1") is None


@pytest.mark.parametrize(
    ("form", "found"),
    [
        ({"rate": 44100}, "8 bit, 1 channels, 44100 Hz found"),
        ({"bits": 16}, "16 bit, 1 channels, 7812 Hz found"),
        ({"channels": 2}, "8 bit, 2 channels, 7812 Hz found"),
    ],
)
def test_a_sound_of_another_form_is_played_with_a_complaint(card: SdCard, form: dict[str, int], found: str) -> None:
    sound(card.folder / "p1.wav", b"\x80\x90" * 8, **form)
    read = card.read_sound("p1")
    assert read is not None
    assert read[0] == b"\x80\x90" * 8
    assert found in read[1]


@pytest.mark.parametrize("rate", [7800, 8000])
def test_rates_that_sound_right_are_no_reason_to_complain(card: SdCard, rate: int) -> None:
    sound(card.folder / "p1.wav", b"\x80", rate=rate)
    assert card.read_sound("p1") == (b"\x80", "")


def test_a_file_that_is_no_sound_is_named(card: SdCard) -> None:
    (card.folder / "p1.wav").write_bytes(b"no sound at all")
    assert card.read_sound("p1") == (b"", "p1.wav: no WAV file found, expected 8 bit, 1 channel, 7800 to 8000 Hz")


def test_a_file_cannot_stand_for_a_card(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.touch()
    with pytest.raises(SdCardError, match=r"file: File .*exists; expected a folder"):
        SdCard(file)


def test_a_card_that_was_taken_out_has_no_files(card: SdCard) -> None:
    card.open(1)
    for path in card.folder.iterdir():
        path.unlink()
    card.folder.rmdir()
    assert (card.write([1]), card.read(1), card.open(2), card.read_sound("p1")) == (0, [], False, None)
    assert not card.write_sound("r1", b"abc")


@posix
def test_links_that_lead_round_and_pipes_are_no_files(card: SdCard) -> None:
    os.symlink(card.folder / "u2.dat", card.folder / "u1.dat")
    os.symlink(card.folder / "u1.dat", card.folder / "u2.dat")
    os.mkfifo(card.folder / "u3.dat")
    assert [card.open(number) for number in (1, 2, 3)] == [False] * 3


def test_a_card_holds_so_many_files(card: SdCard, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cards, "MAX_FILES", 3)
    assert [card.open(number) for number in range(5)] == [True, True, True, False, False]
    assert "holds 3 files" in card.refusal
    assert not card.write_sound("r1", b"abc")
    assert card.open(2)
    assert card.refusal == ""
    (card.folder / "u0.dat").unlink()
    assert card.open(7)
    assert sorted(path.name for path in card.folder.iterdir()) == ["u1.dat", "u2.dat", "u7.dat"]


def test_a_card_holds_so_many_bytes_in_all_files(card: SdCard, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cards, "MAX_BYTES", 60)
    (card.folder / "notes.txt").write_bytes(b"ten bytes.")
    card.open(1)
    assert (card.write([1] * 20), card.refusal) == (20, "")
    card.open(2)
    assert (card.write([2] * 20), card.refusal) == (5, "the card is full: it holds 60 bytes")
    assert not card.write_sound("r1", b"")
    card.open(1)
    assert (card.write([3] * 20), card.refusal) == (20, "")
    assert sum(path.stat().st_size for path in card.folder.iterdir()) == 60


def test_a_gap_counts_as_bytes(card: SdCard, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cards, "MAX_BYTES", 2 * 0xFFFF)
    card.open(1)
    card.seek(0xFFFF)
    assert card.write([1]) == 0
    card.seek(0xFFFE)
    assert card.write([1, 2]) == 1


def test_the_folder_is_not_listed_for_every_name(card: SdCard, monkeypatch: pytest.MonkeyPatch) -> None:
    card.open(0)
    listed = []
    monkeypatch.setattr(os, "scandir", lambda folder: listed.append(folder) or pytest.fail("listed"))
    for number in range(1, 100):
        assert card.open(number)
        assert card.read_sound(f"p{number}") is None
    assert listed == []


def test_a_sound_is_measured_without_being_read(card: SdCard) -> None:
    card.write_sound("r1", bytes(100))
    assert (card.sound_bytes("r1"), card.sound_bytes("r2")) == (100, 0)
