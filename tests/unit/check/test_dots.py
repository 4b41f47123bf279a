"""Labels on dots of small scans, one made of noise alone."""

import numpy as np
import pandas as pd
import pytest
from PIL import Image

from linepose.check.dots import dot_findings
from linepose.inputs.targets.refine import METHODS

DOTS = {0: (20.0, 30.0), 1: (50.0, 30.0), 2: (80.0, 31.0)}


@pytest.fixture
def scans(tmp_path):
    """Scan 1 shows three dots, scan 2 the noise alone."""
    line, u = np.mgrid[:60, :100]
    noise = np.random.default_rng(1).normal(60, 4, (2, *line.shape))
    for x, y in DOTS.values():
        noise[0] += 120 * np.exp(-((u - x) ** 2 + (line - y) ** 2) / 8)
    paths = {number: tmp_path / f"run-{number}.png" for number in (1, 2)}
    for number, path in paths.items():
        Image.fromarray(noise[number - 1].clip(0, 255).astype(np.uint8)).save(path)
    return paths


def labels(rows):
    return pd.DataFrame(rows, columns=["observation", "point", "u_px", "line"])


def told(scans, rows):
    return [finding.found for finding in dot_findings(scans, labels(rows), METHODS["centroid"])]


def test_labels_on_their_dots_pass(scans):
    assert told(scans, [(1, point, u + 2, line - 2) for point, (u, line) in DOTS.items()]) == []


def test_two_labels_of_one_dot_are_named(scans):
    rows = [(1, "a", 22.0, 30.0), (1, "b", 50.0, 30.0), (1, "c", 18.0, 31.0)]
    assert told(scans, rows) == ["two points on one dot: a and c of observation 1"]


def test_dots_in_noise_are_told_by_their_contrast(scans):
    rows = [(number, point, *place) for number in (1, 2) for point, place in DOTS.items()]
    assert [found for found in told(scans, rows) if "noise" in found] == [
        "scan 2: what the labels mark hardly stands out of the noise"
    ]
