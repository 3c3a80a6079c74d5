import subprocess
import sys
from pathlib import Path

import pytest

import aseba_vm

ROOT = str(Path(aseba_vm.__file__).parents[1])

IMPORTING = f"""
import sys
before = set(sys.modules)
sys.path.insert(0, {ROOT!r})
import aseba_vm, aseba_vm.cli.main
print(*{{name.partition('.')[0] for name in set(sys.modules) - before}})
"""


def test_the_public_names_exist_and_are_sorted():
    assert all(hasattr(aseba_vm, name) for name in aseba_vm.__all__)
    assert aseba_vm.__all__ == sorted(aseba_vm.__all__)


def test_public_classes_and_functions_are_explained():
    public = [getattr(aseba_vm, name) for name in aseba_vm.__all__ if name != "Native"]
    assert [thing for thing in public if not thing.__doc__] == []


@pytest.mark.process
def test_the_package_needs_the_standard_library_only():
    found = subprocess.run([sys.executable, "-c", IMPORTING], capture_output=True, text=True, check=True)
    assert set(found.stdout.split()) - set(sys.stdlib_module_names) == {"aseba_vm"}
