import ast
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[3] / "benchmarks"))
from operations import count_operations, floating_point_operations


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("x = a * b + c / d - e", 4),
        ("sums[i, at.W + lane] += a * b", 2),
        ("y = -a if a > b else 2 * b", 1),
        ("u, v = rays[i, at.N + lane], a ** 2 * b", 1),
    ],
)
def test_counts_arithmetic_but_no_indices(source, expected):
    assert count_operations(ast.parse(source)) == expected


def test_grows_with_pairs_and_points():
    def count(n: int, m: int) -> int:
        return floating_point_operations(n, m)

    assert count(7, 6) == 2 * count(7, 3)
    each_pair = count(3, 1) - 2 * count(2, 1) + count(1, 1)  # second difference
    # As the instructions of the compiled loop give: 92 fused, 75 products, 21 sums, 2 quotients, changes of sign apart.
    assert each_pair == pytest.approx(2 * 92 + 75 + 21 + 2, rel=0.05)
