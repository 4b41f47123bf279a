"""Features, pairs of strips and tracks: what is alike, what bears itself out, and what is kept."""

from dataclasses import replace

import numpy as np
import pytest

from linepose.inputs.rectified.rectify import Rectified
from linepose.inputs.rectified.surface import flat_ground
from linepose.inputs.tie_points.features import Features, features_of
from linepose.inputs.tie_points.pairs import Matches, alike, in_consensus, matches_of
from linepose.inputs.tie_points.tracks import thinned, tracks_of

CELL_M = 0.05


def drawn(n, random, extent_m=40.0):
    descriptor = random.standard_normal((n, 128)).astype(np.float32)
    descriptor /= np.linalg.norm(descriptor, axis=1, keepdims=True)
    place = random.uniform(0, extent_m, (n, 2))
    return Features(place, 10 * place[:, 0], 20 * place[:, 1], np.full(n, 0.3), np.ones(n), descriptor)


def test_features_lead_back_to_the_raw_scan():
    random = np.random.default_rng(1)
    coarse = random.standard_normal((40, 50)).astype(np.float32)
    light = np.kron(coarse, np.ones((6, 6), np.float32))
    row, column = np.indices(light.shape)
    light[:, :30] = np.nan  # not seen
    unseen = np.isnan(light)
    u_px = np.where(unseen, np.nan, 0.7 * column + 0.1 * row).astype(np.float32)
    line = np.where(unseen, np.nan, 1.3 * row - 0.05 * column)
    strip = Rectified(light, u_px, line, flat_ground(0.0), np.array([5.0, -3.0]), CELL_M)
    found = features_of(strip, 100)
    assert 50 < len(found) <= 100
    at = (found.place_m - [5.0, -3.0]) / CELL_M
    assert at[:, 0].min() > 30  # the rim of what is seen is no feature
    np.testing.assert_allclose(found.u_px, 0.7 * at[:, 0] + 0.1 * at[:, 1], atol=1e-3)
    np.testing.assert_allclose(found.line, 1.3 * at[:, 1] - 0.05 * at[:, 0], atol=1e-3)
    halves = np.histogram(at[:, 1], bins=[0, 120, 240])[0]
    assert halves.min() > 0.3 * len(found)  # spread over the map


def test_half_of_what_looks_alike_is_wrong_and_is_told_from_the_rest():
    random = np.random.default_rng(2)
    first = random.uniform(0, 40, (200, 2))
    turn = np.array([[1.0, 0.02], [-0.02, 1.01]])
    second = first @ turn.T + [1.0, -0.5] + 0.02 * random.standard_normal((200, 2))
    second[:100] = first[:100] + random.uniform(-6, 6, (100, 2))
    kept = in_consensus(first, second, 1.0, CELL_M)
    assert kept[100:].mean() > 0.9
    assert kept[:100].sum() <= 3  # by chance within 0.2 m of 6 m: one in a thousand; of the consensus' rim some more
    assert not in_consensus(first[:100], second[:100], 0.2, CELL_M).sum() > 20


def test_a_match_is_each_others_best_near_by_and_alone():
    random = np.random.default_rng(3)
    first = drawn(300, random)
    order = random.permutation(300)
    second = replace(first.select(order), place_m=first.place_m[order] + np.array([0.5, -0.4]))
    rows, distance = alike(first, second, 2.0, 0.8)
    assert len(rows) > 290
    assert np.all(order[rows[:, 1]] == rows[:, 0])
    assert distance.max() < 0.02
    far = replace(second, place_m=second.place_m + np.array([5.0, 0.0]))
    assert not len(alike(first, far, 2.0, 0.8)[0])
    paired = np.repeat(np.arange(0, 300, 2), 2)  # each looks and lies like another one
    assert not len(alike(first, second.select(paired), 2.0, 0.8)[0])


def test_what_does_not_bear_itself_out_is_no_match():
    random = np.random.default_rng(4)
    first = drawn(200, random)
    second = replace(first, place_m=first.place_m + random.uniform(-3, 3, (200, 2)))
    found = matches_of(first, second, 4.0, 0.8, 0.2, CELL_M)
    assert found.n_alike > 150
    assert not len(found.rows)


def test_tracks_join_pairs_and_leave_out_what_is_at_two_places_of_a_strip():
    random = np.random.default_rng(5)
    features = [drawn(10, random) for _ in range(3)]

    def pair(*rows):
        return Matches(np.array(rows), np.full(len(rows), 0.1), len(rows))

    matches = {(0, 1): pair((0, 0), (1, 1), (2, 2)), (1, 2): pair((0, 5), (2, 7)), (0, 2): pair((0, 5), (2, 8))}
    tracks = tracks_of(features, matches)
    assert tracks.n_contradicted == 1  # 2: at 7 and 8 of the third strip
    members = {
        tuple(sorted(zip(tracks.strip[tracks.point == k], tracks.row[tracks.point == k], strict=True)))
        for k in range(tracks.n_points)
    }
    assert members == {((0, 0), (1, 0), (2, 5)), ((0, 1), (1, 1))}


@pytest.mark.parametrize("n_points", [40, 1000])
def test_parts_of_strips_count_alike_after_thinning(n_points):
    random = np.random.default_rng(6)
    many = drawn(400, random)
    crowded = replace(many, u_px=np.where(np.arange(400) < 300, many.u_px / 4, many.u_px))  # most in one quarter
    rows = np.arange(400)
    pairs = {(0, 1): Matches(np.column_stack([rows, rows]), np.full(400, 0.1), 400)}
    features = [crowded, crowded]
    kept = thinned(tracks_of(features, pairs), features, n_points)
    assert kept.n_points == min(n_points, 400)
    if n_points == 40:
        quarter = crowded.u_px[kept.row[kept.strip == 0]] < crowded.u_px.max() / 4
        assert quarter.mean() < 0.5  # of 80 % before
