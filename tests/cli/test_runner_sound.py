"""The sound of a run as a file."""

from __future__ import annotations

import json
import wave

import pytest

from thymio_sim_ros.cli.runner_sound import run_with_sound
from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.sim.playground import reader as playgrounds

TWO = json.dumps(
    {
        "format": 1,
        "title": "Two",
        "shapes": [{"kind": "rectangle", "size_x_m": 2.0, "size_y_m": 2.0, "color": "#ffffff"}],
        "robots": [{"name": "anna", "x_m": 0.0, "y_m": 0.5}, {"name": "bert", "x_m": 0.0, "y_m": -0.5}],
    }
)


def heard(tmp_path, source):
    """Samples −128…127 of two robots that run a program for a second."""
    file = tmp_path / "sound.wav"
    engine = Engine(playgrounds.loads(TWO, "two"), load_program(source, "test"))
    run_with_sound(engine, engine.steps(1.0), file)
    with wave.open(str(file)) as sound:
        assert (sound.getnchannels(), sound.getsampwidth(), sound.getframerate()) == (1, 1, 7812)
        return [sample - 128 for sample in sound.readframes(sound.getnframes())]


def test_a_second_has_7812_samples(tmp_path):
    assert heard(tmp_path, "") == [0] * 7812


def test_what_one_robot_plays_is_heard(tmp_path):
    samples = heard(tmp_path, "if _id == 1 then\ncall sound.freq(440, 30)\nend")
    assert max(samples) == 127
    assert max(index for index, sample in enumerate(samples) if sample) == pytest.approx(30 * 128, abs=160)


def test_robots_are_heard_together(tmp_path):
    source = "var wave[142]\ncall math.fill(wave, 50 * _id)\ncall sound.wave(wave)\ncall sound.freq(440, 0)"
    assert set(heard(tmp_path, source)[1000:]) == {127}
    source = "var wave[142]\ncall math.fill(wave, 20 * _id)\ncall sound.wave(wave)\ncall sound.freq(440, 0)"
    assert set(heard(tmp_path, source)[1000:]) == {60}


def test_a_place_that_cannot_be_written_is_refused_before_the_run(tmp_path):
    engine = Engine(playgrounds.loads(TWO, "two"), load_program("", "test"))
    with pytest.raises(OSError, match="No such file"):
        run_with_sound(engine, engine.steps(1.0), tmp_path / "nowhere" / "sound.wav")
    assert engine.now_ns == 0
