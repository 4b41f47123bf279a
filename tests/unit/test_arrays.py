import numpy as np
import pytest

from linepose.arrays import exact_decimal


@pytest.mark.parametrize("value", [0.1, -33.9, 1e-9, 1e22, np.float64(-33.9), np.float32(0.1), np.int64(3)])
def test_decimal_reads_back_to_the_same_number(value):
    assert float(exact_decimal(value)) == float(value)
    assert "np" not in exact_decimal(value)
