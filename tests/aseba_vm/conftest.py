"""Turns each vector of the selected set into a separate test."""

import pytest

from tests.aseba_vm.vectors import SHIPPED, is_set, load


def pytest_generate_tests(metafunc):
    """A test marked ``vectors("aseba-compile")`` runs once for each line of that file."""
    mark = metafunc.definition.get_closest_marker("vectors")
    if mark is None:
        return
    folder = metafunc.config.getoption("vectors") or SHIPPED
    if not is_set(folder):
        raise pytest.UsageError(f"--vectors: no file of vectors in {folder}")
    chosen = [vector for vector in load(mark.args[0], folder) if _is_wanted(vector, **mark.kwargs)]
    metafunc.parametrize("vector", chosen, ids=[vector["id"] for vector in chosen])


def _is_wanted(vector, *, crashes=None):
    return crashes is None or crashes == (vector["expect"]["kind"] == "reference-crash")


@pytest.fixture
def translators_work(caplog):
    """Fail if a translator failed: the interpreter would run instead, and the test would prove nothing."""
    yield
    failures = [record.getMessage() for record in caplog.get_records("call") if "no translation" in record.msg]
    assert not failures
