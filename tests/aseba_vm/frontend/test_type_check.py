import pytest

from aseba_vm import CompileError, compile
from aseba_vm.targets import THYMIO_II


@pytest.mark.parametrize(
    ("source", "kind", "arguments"),
    [
        ("var v[2] v = [1, 2, 3]", "size-mismatch", (2, 3)),
        ("var v[2] v += 1", "size-mismatch", (2, 1)),
        ("for acc in 0:3 do end", "size-mismatch", (3, 1)),
        ("if acc == acc then end", "vector-condition-if", ()),
        ("while acc == acc do end", "vector-condition-while", ()),
        ("var a if a then end", "type-mismatch", ("boolean", "integer")),
        ("var a a = (a == 1)", "type-mismatch", ("integer", "boolean")),
        ("var a if a == 1 and a then end", "type-mismatch", ("boolean", "integer")),
        ("var a if not a then end", "type-mismatch", ("boolean", "integer")),
        ("callsub wait sub weit", "unknown-subroutine-hint", ("wait", "weit")),
    ],
)
def test_sizes_and_types_must_agree(source, kind, arguments):
    with pytest.raises(CompileError) as caught:
        compile(source, THYMIO_II)
    assert (caught.value.kind, caught.value.arguments) == (kind, arguments)


@pytest.mark.parametrize(
    "source",
    [
        "emit e (temperature == 1)",
        "call leds.rc((temperature == 1 and sd.present == 1))",
        "acc[(temperature == 1)] = 3",
    ],
)
def test_types_are_not_checked_everywhere(source):
    source = source.replace(
        "leds.rc(temperature == 1 and sd.present == 1)", "leds.rc((temperature == 1 and sd.present == 1))"
    )
    assert compile(source, THYMIO_II, events=[("e", 1)]).words


def test_all_sizes_are_checked_before_any_type():
    with pytest.raises(CompileError) as caught:
        compile("var a if a then end acc = 1", THYMIO_II)
    assert caught.value.kind == "size-mismatch"
