import pytest

from aseba_vm.frontend.suggestions import suggestion


@pytest.mark.parametrize(
    ("name", "known", "expected"),
    [
        ("countre", ["counter", "counting"], "counter"),
        ("speed", ["speeds", "sped", "spend"], "sped"),
        ("a", ["acc"], "acc"),
        ("x", ["acc"], None),
        ("ab", [], None),
        ("", ["a", "ab", "abc"], "a"),
        ("été", ["ete"], "ete"),
    ],
)
def test_the_nearest_name_within_two_changes_is_suggested(name, known, expected):
    assert suggestion(name, known) == expected


def test_of_equally_near_names_the_first_in_code_point_order_is_suggested():
    assert suggestion("ax", ["az", "ay", "bx"]) == "ay"


def test_very_long_names_are_compared_quickly():
    assert suggestion("a" * 200_000 + "b", ["a" * 200_000 + "c"]) == "a" * 200_000 + "c"
