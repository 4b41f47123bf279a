"""What the draws of the levels are worth, and what helps."""

import pytest

from linepose.adjustment.draws_in_words import draws_in_words


def test_few_draws_are_mended_by_more_a_heavy_tail_is_not():
    few, heavy = draws_in_words(8.0, 0.9), draws_in_words(48.0, 0.75)
    assert "5 times as large" in few.advice  # 40 draws wanted, a draw in so many of 8 is worth
    assert "n_draws" not in heavy.advice
    assert "Add views" in heavy.advice
    assert draws_in_words(20.0, 0.7).advice == ""


@pytest.mark.parametrize(
    ("draws", "shape", "told"),
    [(50.0, 0.7004, "0.7004"), (19.96, 0.5, "worth 19.96,"), (48.0, 0.75, "worth 48, Pareto shape 0.75")],
)
def test_what_has_failed_never_reads_as_passed(draws, shape, told):
    assert told in draws_in_words(draws, shape).found
