"""Square markers that carry a number, as OpenCV draws and finds them."""

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from linepose.survey.targets.artwork import Rectangle

FAMILIES: Final = {"16h5": "APRILTAG_16H5", "25h9": "APRILTAG_25H9", "36h11": "APRILTAG_36H11"}


def dictionary(name: str) -> Any:
    """OpenCV's dictionary of this name, `4X4_50` or a family of AprilTags."""
    import cv2

    known = {key.upper(): getattr(cv2.aruco, key) for key in dir(cv2.aruco) if key.startswith("DICT_")}
    return cv2.aruco.getPredefinedDictionary(known[f"DICT_{FAMILIES.get(name, name)}".upper()])


def n_cells(name: str) -> int:
    """Cells along a side of its markers, their black border included."""
    return int(dictionary(name).markerSize) + 2


def n_markers(name: str) -> int:
    """How many markers there are."""
    return len(dictionary(name).bytesList)


def marker(name: str, number: int, x_m: float, y_m: float, side_m: float) -> tuple[Rectangle, ...]:
    """The print of a marker around a centre: a black square, and its white cells, joined so that no seam shows."""
    import cv2

    side = n_cells(name)
    cells = cv2.aruco.generateImageMarker(dictionary(name), number, side, borderBits=1)
    cell_m, left, top = side_m / side, x_m - side_m / 2, y_m - side_m / 2
    white = np.asarray(cells) > 0
    across = [
        Rectangle(left + begin * cell_m, top + row * cell_m, (end - begin) * cell_m, cell_m, white=True)
        for row, begin, end in _runs(white)
    ]
    along = [
        Rectangle(left + column * cell_m, top + begin * cell_m, cell_m, (end - begin) * cell_m, white=True)
        for column, begin, end in _runs(white.T)
        if end - begin > 1
    ]
    return (Rectangle(left, top, side_m, side_m, white=False), *across, *along)


def _runs(white: NDArray[np.bool_]) -> list[tuple[int, int, int]]:
    """Row, first and next column of every run of white cells in a square (n, n)."""
    edges = np.diff(np.pad(white.astype(np.int8), ((0, 0), (1, 1))), axis=1)
    starts, ends = np.argwhere(edges > 0), np.argwhere(edges < 0)
    return [(int(row), int(begin), int(end)) for (row, begin), (_, end) in zip(starts, ends, strict=True)]


def parameters() -> Any:
    """How markers are looked for: their corners at the crossing of the edges that are fitted to their sides."""
    import cv2

    chosen = cv2.aruco.DetectorParameters()
    chosen.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_CONTOUR
    chosen.minMarkerPerimeterRate = 0.01
    return chosen
