"""A camera in the words of Brown's distortion, as OpenCV, ROS and Kalibr have it: k1, k2, p1, p2 and perhaps k3."""

from typing import TYPE_CHECKING, Final, NamedTuple

from linepose.errors import InputError

if TYPE_CHECKING:
    from linepose.arrays import Floats
    from linepose.geometry.camera import Camera

FARTHEST_PX: Final = 0.1
_REMEDY: Final = "export another format, such as json"


class Brown(NamedTuple):
    """Focal length and centre (px), and the coefficients; k1 x^3 + k2 x^5 + k3 x^7 + 3 p2 x^2 comes to x."""

    focal_px: float
    centre_px: float
    k1: float
    k2: float
    p1: float
    p2: float
    k3: float


def brown(camera: "Camera", place: str, *, has_k3: bool) -> Brown:
    """The coefficients of a camera, or those nearest to its rays; a smile is p1 with its sign turned.

    Raises InputError, naming `place`, where a pixel's ray would be off by more than `FARTHEST_PX`.
    """
    import numpy as np

    ray = all_rays(camera, place)
    if camera.view_angles is None and (has_k3 or camera.k3 == 0):
        pair = float(camera.focal_length_px), float(camera.principal_point_px)
        found = Brown(*pair, camera.k1, camera.k2, 0.0 - camera.smile, camera.p2, camera.k3)
    else:
        found = _nearest(ray, camera.n_pixels, has_k3)
    off_px = float(np.abs(_pixels(found, ray) - np.stack([np.arange(len(ray)), np.zeros(len(ray))], axis=1)).max())
    if off_px > FARTHEST_PX:
        lens = f"a lens that k1, k2, p1, p2{' and k3' if has_k3 else ''} miss by {off_px:.2f} px"
        raise InputError(f"camera of {place}", lens, f"{FARTHEST_PX} px or less", _REMEDY)
    return found


def require_straight(camera: "Camera", place: str, words: str) -> None:
    """Raise InputError for a camera whose line is tilted or bent, which the format named by `words` cannot state."""
    off_px = float(abs(all_rays(camera, place)[:, 1]).max()) * camera.focal_length_px
    if off_px > FARTHEST_PX:
        found = f"a line that lies {off_px:.2f} px off a straight one"
        raise InputError(f"camera of {place}", found, f"{FARTHEST_PX} px or less for {words}", _REMEDY)


def all_rays(camera: "Camera", place: str) -> "Floats":
    """Rays (P, 3) of all pixels; raises InputError where one has none."""
    import numpy as np

    from linepose.geometry.camera import pixel_directions

    ray = pixel_directions(camera, np.arange(camera.n_pixels))
    if not np.all(np.isfinite(ray)):
        found, expected = "a lens that turns back on itself within the line", "one ray a pixel"
        raise InputError(f"camera of {place}", found, expected, "correct k1, k2, k3 and p2")
    return ray


def _nearest(ray: "Floats", n_pixels: int, has_k3: bool) -> Brown:
    import numpy as np

    x, y = ray[:, 0], ray[:, 1]
    columns = np.stack([x, np.ones_like(x), x**3, x**5, 3 * x**2, *([x**7] if has_k3 else [])], axis=1)
    scale = np.abs(columns).max(axis=0)
    solved = np.linalg.lstsq(columns / scale, np.arange(n_pixels), rcond=None)[0] / scale
    focal, centre, *others = map(float, solved)
    k1, k2, p2, k3 = (one / focal for one in (*others, *([] if has_k3 else [0.0])))
    return Brown(focal, centre, k1, k2, -float(y @ x**2 / np.sum(x**4)), p2, k3)


def _pixels(one: Brown, ray: "Floats") -> "Floats":
    """Where rays (P, 3) fall with Brown's distortion, u and v (P, 2)."""
    import numpy as np

    x, y = ray[:, 0], ray[:, 1]
    r2 = x**2 + y**2
    radial = 1 + r2 * (one.k1 + r2 * (one.k2 + r2 * one.k3))
    along = x * radial + 2 * one.p1 * x * y + one.p2 * (r2 + 2 * x**2)
    across = y * radial + one.p1 * (r2 + 2 * y**2) + 2 * one.p2 * x * y
    return np.stack([one.focal_px * along + one.centre_px, one.focal_px * across], axis=1)
