"""Points: by mark, shared by parameters."""

from __future__ import annotations

from fractions import Fraction

import pytest

from thymio_sim_ros.grading.points import points_of

pytestmark = pytest.mark.process


def test_parameters_share_the_points_of_their_function(pytester: pytest.Pytester) -> None:
    items = pytester.getitems(
        """
        import pytest

        def test_plain(): pass

        @pytest.mark.points(2)
        class TestIt:
            @pytest.mark.parametrize("seed", range(3))
            def test_seeds(self, seed): pass

            @pytest.mark.points(0.5)
            def test_own(self): pass
        """
    )
    assert points_of(items) == [1, *[Fraction(2, 3)] * 3, Fraction(1, 2)]


@pytest.mark.parametrize("arguments", ["", "'3'", "-1", "True", "1, 2", "number=3", "float('nan')"])
def test_an_invalid_mark_is_explained(pytester: pytest.Pytester, arguments: str) -> None:
    items = pytester.getitems(f"import pytest\n@pytest.mark.points({arguments})\ndef test_a(): pass")
    with pytest.raises(pytest.UsageError, match=r"test_a: mark points: found .*, expected one number from 0 on"):
        points_of(items)
