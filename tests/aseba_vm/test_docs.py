"""The examples and names of the page and the package are correct."""

import contextlib
import doctest
import io
import re
from pathlib import Path

import aseba_vm

MANUAL = (Path(__file__).parents[2] / "docs" / "aseba_vm.md").read_text("utf-8")


def test_the_example_of_the_manual_runs():
    example = re.search(r"```python\n(.*?)```", MANUAL, re.DOTALL).group(1)
    output = io.StringIO()
    with contextlib.redirect_stdout(output):
        exec(example, {})
    assert output.getvalue() == "Emitted(number=1, arguments=(42,))\n"


def test_the_example_of_the_package_runs():
    assert doctest.testmod(aseba_vm).failed == 0


def test_the_manual_names_what_exists():
    machine = aseba_vm.VirtualMachine(aseba_vm.targets.THYMIO_II)
    program = aseba_vm.compile("", aseba_vm.targets.THYMIO_II)
    calls = set(re.findall(r"`(\w+)\(", MANUAL.partition("## Running")[2].partition("## Debugging")[0]))
    of_natives = {"read", "value", "write", "NativeFault", "VirtualMachine"}
    assert {name for name in calls - of_natives if not hasattr(machine, name)} == set()
    assert all(hasattr(program, name) for name in ("row_of", "addresses_of", "segment_of", "warnings", "addresses"))
