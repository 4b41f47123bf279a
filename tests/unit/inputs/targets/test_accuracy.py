import numpy as np
import pytest

from linepose.inputs.targets.accuracy import accuracy, compare_methods


def test_bias_and_scatter_of_known_errors():
    truth = np.array([[10.0, 20.0], [30.0, 40.0], [50.0, 60.0], [70.0, 80.0]])
    found = truth + np.array([[0.1, -1.0], [0.3, -3.0], [np.nan, np.nan], [0.2, -2.0]])
    measured = accuracy(found, truth, np.full(4, 0.25))
    assert (measured["n_points"], measured["n_missing"]) == (4, 1)
    assert measured["bias_u_px"] == pytest.approx(0.2)
    assert measured["sigma_u_px"] == pytest.approx(0.1)
    assert measured["bias_v_px"] == pytest.approx(-0.5)  # a line is a quarter of a pixel
    assert measured["sigma_v_px"] == pytest.approx(0.25)


def test_each_method_has_a_row():
    methods = {"low": lambda _, u, line: (u - 1, line), "high": lambda _, u, line: (u, line + 2)}
    truth = np.array([[1.0, 2.0], [3.0, 4.0]])
    rate = np.array([-1.0, -1.0])  # a reverse pass
    table = compare_methods(methods, np.zeros((5, 5), dtype=np.float32), truth, truth, rate).set_index("method")
    assert table.loc["low", "bias_u_px"] == -1
    assert table.loc["high", "bias_v_px"] == -2
