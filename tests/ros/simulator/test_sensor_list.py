"""The declarations of sensors as viewers get them."""

import json
from pathlib import Path

import pytest
from std_msgs.msg import String

from tests import plugin_page
from thymio_sim_ros.ros.simulator.sensor_list import displayed_sensors

UNDECLARED = """
from thymio_sim_ros.sim.model.readings import PlainReading
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.sensors import Sensor

SENSOR = Sensor(
    name="compass",
    period_ns=100_000_000,
    measure=lambda view: PlainReading(view.now_ns, (1, 2, 3)),
    aseba=AsebaFace(variables=(("compass.heading", 1), ("compass.field", 2))),
)
"""


def test_built_in_sensors_are_listed_with_units():
    units = {sensor["name"]: [value["unit"] for value in sensor["values"]] for sensor in displayed_sensors()}
    assert units == {"accelerometer": ["m/s²"] * 3, "battery": ["V"], "sound": ["%"], "temperature": ["°C"]}


def test_the_declaration_of_a_plug_in_reaches_the_topic(ros, simulation, tmp_path, monkeypatch):
    with plugin_page.installed(tmp_path, plugin_page.files(), monkeypatch):
        simulation()
        lists = ros.collect(String, "/simulator/_sensors", transient_local=True)
        ros.until(lambda: lists)
    (compass,) = (sensor for sensor in json.loads(lists[-1].data) if sensor["name"] == "compass")
    assert compass["label"] == {"en": "compass", "de": "Kompass", "fr": "boussole", "it": "bussola"}
    assert compass["values"] == [
        {"label": {"en": "heading"}, "unit": "°", "scale": 1.0, "digits": 0, "full_scale": 180, "words": 1}
    ]


def installed_with(folder: Path, monkeypatch: pytest.MonkeyPatch, sensor: str):
    files = plugin_page.files() | {"thymio_extras/compass.py": sensor}
    return plugin_page.installed(folder, files, monkeypatch)


def test_a_sensor_without_declared_values_has_a_row_for_each_variable(tmp_path, monkeypatch):
    with installed_with(tmp_path, monkeypatch, UNDECLARED):
        (compass,) = (sensor for sensor in displayed_sensors() if sensor["name"] == "compass")
    rows = [(row["label"]["en"], row["words"], row["full_scale"]) for row in compass["values"]]
    assert compass["label"] == {"en": "compass"}
    assert rows == [("compass.heading", 1, None), ("compass.field", 2, None)]


def test_a_plug_in_that_shows_words_it_does_not_have_is_skipped(tmp_path, monkeypatch, caplog):
    display = "from thymio_sim_ros.sim.plugin_api.display import DisplayedValue"
    wrong = UNDECLARED.replace("    aseba=", '    values=(DisplayedValue("field", words=4),),\n    aseba=')
    with installed_with(tmp_path, monkeypatch, display + wrong):
        assert "compass" not in [sensor["name"] for sensor in displayed_sensors()]
    assert "sensor compass: values show 4 words, expected at most 3" in caplog.text
