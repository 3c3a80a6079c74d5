"""Packages of messages that only another program has: what is learned, and what is refused without a trace."""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path

import pytest

from thymio_sim_ros.portable_ros import import_hook
from thymio_sim_ros.portable_ros.messages import taught_packages
from thymio_sim_ros.portable_ros.messages.cdr import deserialize, serialize
from thymio_sim_ros.portable_ros.messages.definition_text import DefinitionError
from thymio_sim_ros.portable_ros.messages.interface_files import interfaces, is_package
from thymio_sim_ros.portable_ros.messages.message_class import message_type
from thymio_sim_ros.portable_ros.messages.own_packages import TAUGHT
from thymio_sim_ros.portable_ros.messages.taught_packages import MOST_VALUES, definitions_for, teach


@pytest.fixture(autouse=True)
def _without_a_trace():
    """Forget afterwards what a test taught."""
    yield
    for package in list(TAUGHT):
        taught_packages._replace(package, None)
        for form in ("", ".msg", ".srv", ".action"):
            sys.modules.pop(f"{package}{form}", None)


def test_messages_services_and_actions_of_another_program_are_types() -> None:
    teach(
        "taught_one",
        {"msg/Spot": "float64 x\n", "srv/Add": "int64 a\n---\nint64 sum\n", "action/Go": "Spot to\n---\n---\n"},
    )
    spot = message_type("taught_one/msg/Spot")
    assert deserialize(serialize(spot(x=1.5)), spot).x == 1.5
    assert interfaces("taught_one")["msg/Spot"] == "float64 x\n"
    with_more = {"msg/Spot": "float64 x\n", "msg/Path": "Spot[] spots\n"}
    teach("taught_one", with_more)
    assert message_type("taught_one/msg/Path")().spots == []


def test_a_new_type_is_in_a_module_that_is_imported_already() -> None:
    teach("taught_two", {"msg/Spot": "float64 x\n"})
    module = import_module("taught_two.msg") if import_hook.is_served("rclpy") else None
    teach("taught_two", {"msg/Path": "Spot[] spots\n"})
    assert module is None or module.Path.__name__ == "Path"


@pytest.mark.parametrize(
    ("package", "texts", "reason"),
    [
        ("taught", {"msg/Spot": "float32 x\n"}, "taught/msg/Spot: found another definition .* restart thymio-sim"),
        ("std_msgs", {"msg/Bool": "int8 data\n"}, "std_msgs/msg/Bool: found another definition"),
        ("std_msgs", {"msg/Mine": "int8 data\n"}, "std_msgs/msg/Mine: found a new definition"),
        ("../etc", {"msg/Spot": "int8 x\n"}, "found the package '../etc', expected lower case"),
        ("taught_bad", {"msg/../Spot": "int8 x\n"}, "found the name 'msg/../Spot', expected one such as msg/Num"),
        ("taught_bad", {"msg/Spot": "int x\n"}, "taught_bad/msg/Spot:1: found the type 'int'"),
        ("taught_bad", {"srv/Add": "int8 x\n"}, "taught_bad/srv/Add: found 0 lines '---', expected 1"),
        ("taught_bad", {"msg/A": "B[] x\n", "msg/B": "A[] x\n"}, "taught_bad/msg/A: found a message within"),
        ("taught_bad", {"msg/Huge": "uint8[2000000000] x\n"}, f"msg/Huge: found more than {MOST_VALUES} values"),
        (
            "taught_bad",
            {"msg/A": "B[1000] x\n", "msg/B": "C[1000] x\n", "msg/C": "int8 x\n"},
            f"found more than {MOST_VALUES} values",
        ),
        ("taught_bad", {"msg/Long": "# x\n" * 300_000}, "found more than 1000000 characters"),
    ],
)
def test_what_cannot_be_learned_changes_nothing(package: str, texts: dict[str, str], reason: str) -> None:
    teach("taught", {"msg/Spot": "float64 x\n"})
    with pytest.raises(DefinitionError, match=reason):
        teach(package, texts)
    assert list(TAUGHT) == ["taught"]
    assert not is_package("taught_bad")
    assert message_type("taught/msg/Spot")(x=1.5).x == 1.5


def test_a_program_sends_its_packages_in_the_order_in_which_they_need_each_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, text in (("sent_base", "float64 x\n"), ("sent_user", "sent_base/Spot spot\nstd_msgs/Header header\n")):
        (tmp_path / name / "msg").mkdir(parents=True)
        (tmp_path / name / "msg" / "Spot.msg").write_text(text, encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    known: set[str] = set()
    assert [package for package, _ in definitions_for("sent_user", known)] == ["sent_base", "sent_user"]
    assert [*definitions_for("sent_base", known), *definitions_for("std_msgs", known)] == []
