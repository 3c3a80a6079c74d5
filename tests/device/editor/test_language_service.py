"""Answers of the language service to an editor."""

import json

import pytest

from aseba_vm.languages import texts
from aseba_vm.targets import THYMIO_II
from thymio_sim_ros.device.editor.help_order import ORDER
from thymio_sim_ros.device.editor.language_service import (
    MOST_CHARACTERS,
    Question,
    check,
    describe_program,
    describe_target,
    doubts,
    is_hidden,
)
from thymio_sim_ros.device.layout import PLAYGROUND, target
from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.files import resources

FILE = """<network>
<event size="1" name="ping"/>
<constant value="200" name="SPEED"/>
<node nodeId="1" name="thymio-II">var counter = SPEED
onevent ping
    motor.left.targt = 1
</node>
<node nodeId="2" name="thymio-II">sub turn
    return
onevent prox
    emit ping 1
</node>
</network>
"""


def test_an_error_has_its_place_in_the_text_that_was_given():
    answer = check(Question(FILE))
    (error,) = answer["errors"]
    assert (error["line"], error["column"], error["length"]) == (6, 5, len("motor.left.targt"))
    assert error["kind"] == "unknown-variable-hint"
    assert "perhaps you meant 'motor.left.target'" in error["message"]


def test_other_programs_of_the_file_are_checked_too():
    answer = check(Question(FILE))
    assert [node["compiles"] for node in answer["nodes"]] == [False, True]
    (warning,) = answer["warnings"]
    assert (warning["line"], warning["kind"]) == (8, "warning-uncalled-subroutine")
    assert answer["nodes"][1]["subroutines"] == [{"name": "turn", "line": 8, "column": 39}]
    assert answer["nodes"][1]["handlers"] == [{"name": "prox", "line": 10, "column": 9}]


def test_events_and_constants_of_the_file_are_listed():
    answer = check(Question(FILE))
    assert answer["events"] == [{"name": "ping", "size": 1}]
    assert answer["constants"] == [{"name": "SPEED", "value": 200}]


def test_a_bare_program_may_bring_its_events_and_constants():
    answer = check(Question("onevent ping\nemit ping SPEED", events=(("ping", 1),), constants=(("SPEED", 7),)))
    assert answer["errors"] == []


def test_a_program_that_compiles_has_addresses_and_memory_use():
    (node,) = check(Question("var a[3]\nvar b = 1\nonevent prox\nb = 2"))["nodes"]
    end = target().variables_end
    assert node["variables"] == [
        {"name": "a", "line": 1, "column": 5, "address": end, "size": 3},
        {"name": "b", "line": 2, "column": 5, "address": end + 3, "size": 1},
    ]
    assert node["use"]["variables"] == (end + 4, target().variables_size)
    assert node["use"]["bytecode"][1] == 1534


def test_names_are_listed_as_far_as_a_broken_text_can_be_parsed():
    (node,) = check(Question("var a[3]\nsub s\n  a[0] = \nvar late = $"))["nodes"]
    assert [symbol["name"] for symbol in node["variables"]] == ["a", "late"]
    assert node["variables"][0]["address"] is None
    assert [symbol["name"] for symbol in node["subroutines"]] == ["s"]


def test_broken_xml_is_an_error_with_its_place():
    (error,) = check(Question('<network>\n<node name="thymio-II">\n</network>'))["errors"]
    assert (error["line"], error["kind"]) == (3, "xml-closing-tag")


def test_a_guess_about_a_node_is_a_note_in_the_language():
    text = '<network>\n<node name="anna">var a</node>{}</network>'
    (note,) = check(Question(text.format("")))["notes"]
    assert (note["kind"], note["node"], note["line"]) == ("note-only-node", "anna", 2)
    assert check(Question(text.format(""), robots=("anna",)))["notes"] == []
    answer = check(Question(text.format('<node name="bert">a = 1</node>'), robots=("anna",), language="de"))
    assert answer["errors"] == []
    (note,) = answer["notes"]
    assert note["message"].startswith("der Knoten 'bert' wird ausgelassen")


def test_a_text_that_is_too_long_is_not_read():
    (error,) = check(Question("#" * (MOST_CHARACTERS + 1)))["errors"]
    assert error["kind"] == "request"
    assert str(MOST_CHARACTERS) in error["message"]


def test_a_program_too_large_for_the_memory_is_an_error_without_a_place():
    (error,) = check(Question("var a = 0\n" + "a = a + 1\n" * 700))["errors"]
    assert (error["line"], error["kind"]) == (None, "bytecode-too-large")


def test_messages_come_in_the_language_that_has_them(add_language):
    add_language("xx", compiler={"unknown-event": "xx {0}"})
    answers = [check(Question("onevent zzzzz", language=language)) for language in ("xx", "en", "yy")]
    said = [answer["errors"][0]["message"] for answer in answers]
    assert said == ["xx zzzzz", "no event is called 'zzzzz'", "no event is called 'zzzzz'"]
    assert "expected" in check(Question("var 3", language="xx"))["errors"][0]["message"]


@pytest.mark.parametrize("name", sorted(resources.behaviours()))
def test_every_program_we_ship_is_without_errors_and_warnings(name):
    answer = check(Question(resources.find_program(name).read_text(encoding="utf-8")))
    assert (answer["errors"], answer["warnings"]) == ([], [])


def test_the_target_lists_all_that_a_program_can_use():
    reported = json.loads(json.dumps(describe_target()))
    assert {
        "name": "button.center",
        "size": 1,
        "address": target().addresses["button.center"][0],
        "hidden": False,
        "topic": "sensors",
        "help": texts("help")["variables.button.center"],
    } in reported["variables"]
    assert {"name": "prox", "topic": "sensors", "help": texts("help")["events.prox"]} in reported["events"]
    natives = {entry["name"]: entry for entry in reported["natives"]}
    assert natives["leds.top"]["parameters"][0] == {"name": "red", "size": 1}
    assert natives["_poweroff"]["hidden"]
    assert reported["limits"]["bytecode"] == 1534
    assert "onevent" in reported["keywords"]
    assert len(describe_target(PLAYGROUND)["natives"]) < len(reported["natives"])


def test_what_beginners_need_most_comes_first():
    reported = describe_target()
    names = {kind: [entry["name"] for entry in reported[kind]] for kind in ("variables", "natives", "events")}
    assert names["variables"][:2] == ["motor.left.target", "motor.right.target"]
    assert names["natives"][0] == "leds.top"
    families = list(dict.fromkeys(name.split(".")[0] for name in names["natives"] if not name.startswith("_")))
    assert families[:4] == ["leds", "sound", "prox", "math"]
    places = {name: place for place, name in enumerate(names["variables"])}
    assert places["motor.left.target"] < places["motor.left.speed"] < places["motor.left.pwm"]
    assert max(place for name, place in places.items() if not is_hidden(name)) < places["_id"]


@pytest.mark.parametrize("kind", ["variables", "natives", "events"])
def test_every_name_for_beginners_has_its_place_and_no_other_name(kind):
    known = [entry.name for entry in getattr(THYMIO_II, {"events": "local_events"}.get(kind, kind))]
    assert sorted(ORDER[kind]) == sorted(name for name in known if not is_hidden(name))


def test_help_begins_with_what_beginners_need():
    reported = describe_target()
    assert reported["topics"][:4] == ["motors", "lights", "sound", "sensors"]
    topics = {entry["name"]: entry["topic"] for kind in ("variables", "natives", "events") for entry in reported[kind]}
    assert topics["motor.left.target"] == "motors"
    assert topics["leds.bottom.left"] == "lights"
    assert topics["prox.ground.delta"] == "sensors"
    assert topics["prox.comm.rx"] == topics["prox.comm.enable"] == "messages"
    assert {topic for name, topic in topics.items() if not is_hidden(name)} == set(reported["topics"]) - {"others"}


def test_every_name_of_the_robot_has_help():
    reported = describe_target()
    entries = [entry for kind in ("variables", "natives", "events") for entry in reported[kind]]
    assert [entry["name"] for entry in entries if not entry["help"]] == []


def test_help_comes_in_the_language_that_has_it(add_language):
    add_language("xx", help={"variables.acc": "xx"})
    reported = {entry["name"]: entry["help"] for entry in describe_target(language="xx")["variables"]}
    assert reported["acc"] == "xx"
    assert reported["leds.top"] == texts("help")["variables.leds.top"]


def test_a_loaded_program_is_described_with_the_topics_of_its_events():
    text = FILE.replace("targt", "target")
    reported = describe_program(load_program(text, "maze.aesl"), {"ping": "ping"})
    assert (reported["name"], reported["node"], reported["first_line"]) == ("maze.aesl", "thymio-II", 4)
    assert reported["source"].startswith("var counter")
    assert reported["file"] == text
    assert reported["events"] == [{"name": "ping", "size": 1, "topic": "ping"}]
    assert reported["variables"][0]["line"] == 4


def test_doubts_about_a_program_have_their_place():
    (doubt,) = doubts(load_program("onevent prox\nreturn\nsub s\nreturn", "test"))
    assert (doubt["line"], doubt["kind"]) == (3, "warning-uncalled-subroutine")
