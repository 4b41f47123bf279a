from dataclasses import replace

import numpy as np
import pytest

from linepose.simulation.projection import exact_projections
from linepose.simulation.record import true_lines
from linepose.simulation.render import _turned_grid, line_times_s, render
from linepose.simulation.settings import FaultSettings, GroundSettings
from linepose.survey.pattern import DOT_DIAMETER_M

REACH_PX = 4  # the dot and its blur, well within the ring's inner edge


def dot_centre(light, u, line, half_lines):
    """Centroid of what is brighter than the dark print around a dot: (u, line)."""
    rows = np.arange(round(line) - half_lines, round(line) + half_lines + 1)
    columns = np.arange(round(u) - REACH_PX, round(u) + REACH_PX + 1)
    patch = light[np.ix_(rows, columns)].astype(float)
    excess = np.clip(patch - 1.3 * np.median(patch[:, [0, -1]]), 0, None)
    return (excess.sum(axis=0) @ columns) / excess.sum(), (excess.sum(axis=1) @ rows) / excess.sum()


@pytest.mark.parametrize(("observation", "smile"), [(1, 0.0), (2, 0.0), (3, 0.0), (1, 0.3)])
def test_rendered_dots_lie_at_the_exact_projections(camera, settings, observation, smile):
    camera = camera.replaced(smile=smile)
    light = render(camera, settings, observation).light
    truth, lines = exact_projections(camera, settings), true_lines(camera, settings)
    speed = abs(settings.passes[observation - 1].speed_m_s)
    lines_per_m = settings.image.line_rate_hz / speed
    half_lines = round(0.014 * lines_per_m)
    range_m = np.linalg.norm(truth.position_m[observation - 1].mean(axis=0))
    # samples one step apart misplace a dot's two edges by half a step each, and the edges are a step of its diameter;
    # along the drive the view is oblique by 1 / cos 56 deg = 1.8
    step_m = settings.image.ifov_rad * range_m / settings.image.supersampling
    off_m = step_m**2 / DOT_DIAMETER_M
    for u, line in zip(truth.u_px[observation - 1], lines[observation - 1], strict=True):
        found_u, found_line = dot_centre(light, u, line, half_lines)
        assert found_u == pytest.approx(u, abs=off_m / range_m * camera.focal_length_px)
        assert found_line == pytest.approx(line, abs=off_m * 1.8 * lines_per_m)


@pytest.mark.parametrize("n", [1, 2, 4, 6])
def test_samples_fill_the_field_of_view_evenly_and_none_shares_its_row(n):
    grid = _turned_grid(n)
    np.testing.assert_array_equal(np.unique(np.floor((grid + 0.5) * n), axis=1).shape, (2, n * n))
    for along in grid:
        np.testing.assert_allclose(np.sort(along), (np.arange(n * n) + 0.5) / (n * n) - 0.5, atol=1e-15)
    assert grid[0] @ grid[1] == pytest.approx(0, abs=1e-12)  # no shear of what is seen


def test_edge_in_a_slow_pass_is_a_slope_not_a_flight_of_stairs(camera, settings):
    slow = flat_passes(settings, 0.02)
    slow = replace(slow, image=replace(slow.image, supersampling=4))
    light, lines = render(camera, slow, 1).light, true_lines(camera, slow)[0]
    u = round(exact_projections(camera, slow).u_px[0, 7])
    middle = round(lines[7])
    hole_to_ring = light[middle : middle + round(0.05 * 133 / 0.02), u].astype(float)
    steps = np.abs(np.diff(hole_to_ring))
    # 32 samples, 16 at each of 2 moments: no step is as high as a straight grid's row of four
    assert 0 < steps.max() < 3.5 / 32 * np.ptp(hole_to_ring)


def flat_passes(settings, *speeds):
    passes = tuple(replace(settings.passes[0], speed_m_s=speed, duration_s=1.2 / abs(speed)) for speed in speeds)
    image = replace(settings.image, supersampling=2, ground_contrast=0.0, lighting_gradient_per_m=(0.0, 0.0))
    return replace(settings, passes=passes, ground=GroundSettings(body_height_m=1.0), image=image)


def resampled_along_track(camera, settings, observation):
    """The scan's light at fixed places along the drive, whatever the speed."""
    exposure = render(camera, settings, observation)
    middle = exact_projections(camera, settings).time_s[observation - 1].mean()
    place_m = (exposure.time_s - middle) * settings.passes[observation - 1].speed_m_s
    order = np.argsort(place_m)
    grid = np.linspace(-0.25, 0.25, 200)
    rows = np.searchsorted(place_m[order], grid)
    return exposure.light[order][rows]


def test_reverse_pass_is_the_mirror_image(camera, settings):
    both = flat_passes(settings, 0.2, -0.2)
    forward, reverse = (resampled_along_track(camera, both, number) for number in (1, 2))
    unlike = np.mean(np.abs(forward - reverse[::-1]))
    # neighbouring lines may be taken: a quarter of the blur's width, so a quarter of the contrast and only at edges
    assert np.mean(np.abs(forward - reverse)) < 0.1 * unlike
    lines = true_lines(camera, both)
    np.testing.assert_array_equal(np.argsort(lines[0]), np.argsort(-lines[1]))


def test_slow_pass_is_stretched(camera, settings):
    both = flat_passes(settings, 0.2, 0.05)
    lines = true_lines(camera, both)
    np.testing.assert_allclose(np.diff(lines[1]), 4 * np.diff(lines[0]), rtol=1e-6)
    assert len(line_times_s(camera, both, 2)) == pytest.approx(4 * len(line_times_s(camera, both, 1)), abs=4)
    fast, slow = (resampled_along_track(camera, both, number) for number in (1, 2))
    assert np.mean(np.abs(fast - slow)) < 0.1 * np.mean(np.abs(fast - slow[::-1]))


def test_missing_points_are_covered_by_ground(camera, settings):
    image = replace(settings.image, supersampling=2, ground_contrast=0.0, lighting_gradient_per_m=(0.0, 0.0))
    plain = replace(settings, passes=settings.passes[:1], image=image)
    covered = replace(plain, faults=(FaultSettings(observation=1, missing_points=(9,)),))
    clean, without = (render(camera, one, 1).light for one in (plain, covered))
    truth, lines = exact_projections(camera, plain), true_lines(camera, plain)
    for point in range(15):
        at = round(lines[0, point]), round(truth.u_px[0, point])
        if point == 9:
            assert without[at] == pytest.approx(image.ground_reflectance, abs=1e-6)
        else:
            assert without[at] == clean[at] > image.ground_reflectance


def test_light_follows_the_gradient_and_stays_between_the_reflectances(camera, settings):
    flat_light = replace(settings.image, supersampling=2, ground_contrast=0.0, lighting_gradient_per_m=(0.0, 0.0))
    light = render(camera, replace(settings, image=flat_light), 1).light
    assert light.min() >= np.float32(flat_light.dark_reflectance) * (1 - 1e-6)
    assert light.max() <= np.float32(flat_light.bright_reflectance) * (1 + 1e-6)
    tilted = replace(flat_light, lighting_gradient_per_m=(0.3, 0.0))
    ratio = render(camera, replace(settings, image=tilted), 1).light / light
    truth, lines = exact_projections(camera, settings), true_lines(camera, settings)
    at = [(round(lines[0, point]), round(truth.u_px[0, point])) for point in (0, 4)]
    # points 0 and 4 are 4 x 0.1511 m apart; a pixel is a few millimetres wide
    assert ratio[at[1]] - ratio[at[0]] == pytest.approx(0.3 * 4 * 0.1511, abs=0.3 * 0.01)


def test_scan_does_not_depend_on_the_threads(camera, settings):
    import numba

    quick = replace(settings, image=replace(settings.image, supersampling=2))
    threads = numba.get_num_threads()
    try:
        numba.set_num_threads(1)
        alone = render(camera, quick, 1).light
    finally:
        numba.set_num_threads(threads)
    np.testing.assert_array_equal(alone, render(camera, quick, 1).light)
