import sys

import pytest

from aseba_vm.frontend.trampoline import run


def depth_of(levels):
    if levels == 0:
        return 0
    below = yield depth_of(levels - 1)
    return below + 1


def failing(levels):
    if levels == 0:
        raise KeyError("bottom")
    yield failing(levels - 1)


def test_depth_does_not_depend_on_the_limit_of_python():
    assert run(depth_of(20 * sys.getrecursionlimit())) == 20 * sys.getrecursionlimit()


def test_exceptions_pass_through():
    with pytest.raises(KeyError, match="bottom"):
        run(failing(5000))
