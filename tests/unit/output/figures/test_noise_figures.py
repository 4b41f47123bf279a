"""The figures of the noise models: what is drawn where, and what the captions say."""

import numpy as np
from matplotlib.colors import to_hex

from linepose.estimation.noise_models import NOISE_MODELS, noise_model
from linepose.output.figures.consistency import consistency, consistency_caption
from linepose.output.figures.identifiability import identifiability, identifiability_caption
from linepose.output.figures.noise_models import noise_models, noise_models_caption
from linepose.output.figures.style import RED
from linepose.output.figures.weights import weights, weights_caption
from unit import made_up


def test_each_model_has_its_marks_where_its_estimates_are():
    figure = noise_models(made_up.noise_models(), made_up.platform().start_pose(), made_up.OPTIMUM)
    panel = figure.axes[1]
    places = {
        container.get_label(): np.array(container.lines[0].get_xdata(), dtype=float) for container in panel.containers
    }
    np.testing.assert_allclose(places["published"], made_up.OPTIMUM[1] - 0.14)
    np.testing.assert_allclose(places["shared"], made_up.OPTIMUM[1])
    assert {text.get_text() for text in figure.legends[0].get_texts()} == {*NOISE_MODELS, "by hand", "truth"}
    assert "0 mm shared" in noise_models_caption(made_up.noise_models())


def test_halves_are_steps_from_zero_to_one_and_pairs_are_marks_on_the_right_curve():
    figure = consistency(made_up.consistency())
    lines = figure.axes[0].lines
    by_colour = {to_hex(line.get_color()): line for line in lines if len(line.get_xdata()) == 40}
    assert set(by_colour) == {to_hex(noise_model(name).colour) for name in ("published", "shared")}
    published = by_colour[to_hex(noise_model("published").colour)]
    assert np.all(np.diff(published.get_xdata()) > 0)
    assert published.get_ydata()[-1] == 1.0
    marks = [line for line in lines if len(line.get_xdata()) == 1]
    assert sorted(float(mark.get_xdata()[0]) for mark in marks) == [2.5, 4.0]
    # medians 4.39 and 2.89 over that of chi with six degrees of freedom, 2.313
    assert "1.90 published, 1.25 shared" in consistency_caption(made_up.consistency_summary())


def test_removed_views_are_red_and_the_lowest_weights_are_named():
    figure = weights(made_up.weights())
    colours = [to_hex(bar.get_facecolor()) for bar in figure.axes[0].patches]
    assert [colour == to_hex(RED) for colour in colours] == [False] * 4 + [True] * 2
    caption = weights_caption(made_up.weights())
    assert "6 (0.10), 5 (0.30)" in caption
    assert "2 are among the 2 of lowest weight" in caption
    assert "2 in observation 1 (0.05)" in caption


def test_the_weakest_direction_is_red_and_told_in_words():
    figure = identifiability(made_up.identifiability(), made_up.noise_models())
    bars = figure.axes[0].patches
    assert [to_hex(bar.get_facecolor()) == to_hex(RED) for bar in bars] == [False] * 10 + [True]
    np.testing.assert_allclose([bar.get_width() for bar in bars], np.linspace(0.1, 0.9, 11))
    caption = identifiability_caption(made_up.identifiability(), made_up.noise_models())
    assert "the focal length against r_x" in caption
    assert "a = 0.5, b = 0.03, g = 2.3" in caption
