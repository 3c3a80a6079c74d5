import string

from aseba_vm.languages import texts
from aseba_vm.messages import MESSAGES, format_message
from tests.aseba_vm.vectors import as_tuple, load


def test_every_kind_of_error_has_a_wording():
    kinds = {vector["expect"]["kind"] for vector in load("aseba-errors")} - {"reference-crash"}
    assert kinds <= MESSAGES.keys()


def test_the_wording_is_that_of_the_specification():
    answers = [vector["expect"] for vector in load("aseba-errors") if vector["expect"]["kind"] != "reference-crash"]
    spoken = [format_message(answer["kind"], as_tuple(answer["args"])) for answer in answers]
    assert spoken == [answer["message"] for answer in answers]


def test_templates_name_arguments_by_number():
    names = {name for text in MESSAGES.values() for _, name, _, _ in string.Formatter().parse(text) if name}
    assert all(name.lstrip("tlv").isdigit() for name in names)


def test_tokens_are_described_for_people():
    assert (
        format_message("expected-token", ("identifier", "end-of-input"))
        == "expected a name but found the end of the program"
    )
    assert format_message("expected-identifier", (("integer", 5),)) == "expected a name but found number 5"


def test_another_language_is_another_table():
    german = {"lone-exclamation": "nach '!' muss '=' stehen"}
    assert format_message("lone-exclamation", (), german) == "nach '!' muss '=' stehen"


def test_very_long_names_are_cut():
    assert len(format_message("unknown-variable", ("x" * 1_000_000,))) < 120


def test_an_unknown_kind_is_shown_as_it_is():
    assert format_message("new-kind", (1, "a")) == "new-kind 1 a"


def test_tokens_are_named_in_the_language_of_the_message():
    german = texts("compiler", "de")
    assert format_message("expected-token", ("identifier", "end-of-input"), german) == (
        "erwartet wird ein Name, hier steht das Ende des Programms"
    )
    assert (
        format_message("expected-identifier", (("integer", 5),), german)
        == "erwartet wird ein Name, hier steht die Zahl 5"
    )
    assert format_message("expected-one-of", (("integer", "("), ")"), german) == (
        "erwartet wird eins davon: eine Zahl, '('; hier steht ')'"
    )
