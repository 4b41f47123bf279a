"""From pairs to tracks: one point in as many strips as show it, thinned so that all parts of strips count alike."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.inputs.tie_points.features import Features
from linepose.inputs.tie_points.pairs import Matches

_ALONG, _ACROSS = 8, 4  # parts of a strip
_BESIDE: Final = 0.5  # worth of a match that is as unlike as matches are, beside one that is alike


@dataclass(frozen=True)
class Tracks:
    """Members (L,): point 0 to M - 1, strip, and row among the strip's features; n_contradicted: tracks left out."""

    point: NDArray[np.int64]
    strip: NDArray[np.int64]
    row: NDArray[np.int64]
    worth: Floats
    n_contradicted: int

    @property
    def n_points(self) -> int:
        """How many points there are."""
        return len(self.worth)


def tracks_of(features: Sequence[Features], matches: Mapping[tuple[int, int], Matches]) -> Tracks:
    """Matches of pairs of strips joined to tracks; one that is at two places of a strip is left out, and counted."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    first = np.concatenate([[0], np.cumsum([len(one) for one in features])])
    empty = np.zeros((0, 2), dtype=np.int64)
    edges = np.concatenate([empty, *(found.rows + first[list(pair)] for pair, found in matches.items())])
    unlike = np.concatenate([np.zeros(0), *(found.distance for found in matches.values())])
    graph = coo_matrix((np.ones(len(edges)), edges.T), shape=(first[-1], first[-1]))
    label = connected_components(graph, directed=False)[1]
    node = np.unique(edges)
    strip = np.searchsorted(first, node, side="right") - 1
    names, point = np.unique(label[node], return_inverse=True)
    pairs = np.unique(np.column_stack([point, strip]), axis=0, return_counts=True)
    bad = np.unique(pairs[0][pairs[1] > 1, 0])
    of_edge = np.searchsorted(names, label[edges[:, 0]])
    contrast = np.concatenate([np.zeros(0), *(one.worth for one in features)])[node]
    worth = _mean(of_edge, 1 / (_BESIDE + unlike), len(names)) * _mean(point, contrast, len(names))
    good = np.setdiff1d(np.arange(len(names)), bad)
    kept = np.isin(point, good)
    return Tracks(np.searchsorted(good, point[kept]), strip[kept], (node - first[strip])[kept], worth[good], len(bad))


def thinned(tracks: Tracks, features: Sequence[Features], n_points: int) -> Tracks:
    """At most so many points, the worthiest of each part of each strip, those in many strips first."""
    part = np.zeros(len(tracks.strip), dtype=np.int64)
    for strip, one in enumerate(features):
        rows = np.flatnonzero(tracks.strip == strip)
        if len(rows):
            along = _part(one.line[tracks.row[rows]], one.line, _ALONG)
            across = _part(one.u_px[tracks.row[rows]], one.u_px, _ACROSS)
            part[rows] = (strip * _ALONG + along) * _ACROSS + across
    order = np.argsort(tracks.point, kind="stable")
    members = np.split(part[order], np.searchsorted(tracks.point[order], np.arange(1, tracks.n_points)))
    count = np.zeros(len(features) * _ALONG * _ACROSS, dtype=np.int64)
    n_members = np.bincount(tracks.point, minlength=tracks.n_points)
    best_first = np.lexsort(np.stack([-tracks.worth, -n_members]))
    chosen: list[int] = []
    left, quota = [int(one) for one in best_first], 1
    while left and len(chosen) < n_points:
        still = []
        for point in left:
            if len(chosen) < n_points and count[members[point]].min() < quota:
                count[members[point]] += 1
                chosen.append(point)
            else:
                still.append(point)
        left, quota = still, quota + 1
    return _selected(tracks, np.sort(np.array(chosen, dtype=np.int64)))


def _selected(tracks: Tracks, points: NDArray[np.int64]) -> Tracks:
    kept = np.isin(tracks.point, points)
    point = np.searchsorted(points, tracks.point[kept])
    return Tracks(point, tracks.strip[kept], tracks.row[kept], tracks.worth[points], tracks.n_contradicted)


def _mean(group: NDArray[np.int64], values: Floats, n: int) -> Floats:
    """Mean of the values (L,) of each of n groups."""
    return np.asarray(np.bincount(group, values, n) / np.maximum(np.bincount(group, minlength=n), 1))


def _part(values: Floats, all_values: Floats, n_parts: int) -> NDArray[np.int64]:
    """Which of equal parts of the range of all values these are in."""
    low, high = all_values.min(), all_values.max()
    return np.asarray(np.clip((n_parts * (values - low) / max(high - low, 1e-9)).astype(np.int64), 0, n_parts - 1))
