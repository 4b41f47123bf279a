"""The report read as a browser reads it: pictures, links, headings, alternative texts, tables; nothing from outside."""

import base64
import dataclasses
import io
import re
from html.parser import HTMLParser
from itertools import pairwise

import numpy as np
import pytest
from PIL import Image

from linepose.errors import InputError
from linepose.experiments.prior import prior_table
from linepose.geometry.pose_with_covariance import PoseWithCovariance
from linepose.output.figures.registry import FIGURES
from linepose.output.report.pictures import embedded
from linepose.output.report.provenance import settings_text
from linepose.pipeline.evidence import angles, gather_evidence, pose_numbers, tilt_spread_deg
from linepose.survey.observations import survey_from_table
from unit import made_up

VOID = {"meta", "link", "img", "br"}


class Reader(HTMLParser):
    """Notes every element with its attributes, and checks that each one is closed."""

    def __init__(self):
        super().__init__()
        self.elements, self.open, self.text = [], [], []

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open and self.open[-1] != "style":
            self.text.append(data)

    def all(self, tag):
        return [attributes for name, attributes in self.elements if name == tag]


@pytest.fixture(scope="module")
def read(page):
    reader = Reader()
    reader.feed(page)
    assert reader.open == []
    return reader


def left_out():
    """Places of the figures that a platform of labelled views without further experiments has none of."""
    names = [f"made-up-{entry.name}" for entry in FIGURES if entry.left_out(made_up.platform())]
    assert {"made-up-stacked_scan", "made-up-labelled_points", "made-up-detected_points"} <= set(names)
    return names


def test_every_figure_is_a_picture_in_the_page_with_an_alternative_text(read):
    images = read.all("img")
    assert len(images) == len(FIGURES) - len(left_out())
    for image in images:
        head, data = image["src"].split(",", 1)
        assert head == "data:image/png;base64"
        with Image.open(io.BytesIO(base64.b64decode(data))) as picture:
            picture.load()
            assert picture.size == (int(image["width"]), int(image["height"]))
        assert image["alt"].startswith("made-up: ")


def test_what_is_left_out_has_its_sentence(read):
    assert [one["id"] for one in read.all("div") if one.get("class") == "left-out"] == left_out()
    assert "no scans" in " ".join(read.text)


def test_every_link_leads_somewhere_in_the_page_and_names_are_unique(read):
    names = [attributes["id"] for _, attributes in read.elements if "id" in attributes]
    assert len(names) == len(set(names))
    links = [one["href"] for one in read.all("a")]
    inside = [link for link in links if link != "../report.html"]
    assert inside
    assert len(links) - len(inside) == 1
    assert all(link[0] == "#" and link[1:] in names for link in inside)


def test_headings_step_down_one_at_a_time(read):
    levels = [int(tag[1]) for tag, _ in read.elements if re.fullmatch("h[1-6]", tag)]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(after <= before + 1 for before, after in pairwise(levels))


def test_every_table_has_a_caption_and_heads_with_a_scope(read):
    assert len(read.all("table")) == len(read.all("caption")) >= 5
    assert {one["scope"] for one in read.all("th")} == {"row", "col"}


def test_nothing_is_asked_of_the_network_and_no_place_of_this_machine_is_told(read, page, results):
    addresses = [
        value for _, attributes in read.elements for key, value in attributes.items() if key in ("src", "href")
    ]
    assert all(address.startswith(("data:", "#")) or address == "../report.html" for address in addresses)
    assert not read.all("script")
    assert "url(" not in page
    assert "@import" not in page
    assert "/home/someone" not in page
    assert ".../data" in page
    assert str(results.results.folder) not in page


def test_names_from_files_are_escaped(page):
    assert "Fast &amp; &lt;made up&gt;" in page
    assert "<made up>" not in page


def test_the_page_answers_from_the_top(read):
    text = " ".join(" ".join(read.text).split())
    assert "Use this pose with care: look at 4 of 9 checks." in text
    assert re.search(r"Random halves of the observations lie (1\.9|2\.0)\d times as far apart as stated\.", text)
    assert "What to do: Multiply the sigmas by 2.0" in text
    assert "r_x forward (m) 0.1900 0.03" in text  # the pose with its sigma
    assert "Chain too short: 20 steps" in text
    assert "Quaternion (w, x, y, z)" in text


def test_settings_keep_values_and_lose_folders():
    text = settings_text({"a": {"b": ["/x/y/z", "rel/z", 1.5]}, "n": None})
    assert text == "a:\n  b: ['.../z', rel/z, 1.5]\nn: null"


def test_evidence_is_gathered_from_the_results(results):
    evidence = gather_evidence(results)
    assert (evidence.n_observations, evidence.n_accepted, evidence.n_steps) == (6, 4, 20)
    assert (evidence.worst_observation, evidence.worst_error_px) == (4, 3.0)
    assert (evidence.most_influential, evidence.influence) == (3, 1.5)
    assert evidence.intraclass_correlation == pytest.approx(1.0)
    assert evidence.truth_sigmas is None
    assert evidence.undecided == ()
    # two of the four accepted observations are rolled by 5 deg, two are not: 2.5 deg from their mean
    assert evidence.tilt_spread_deg == pytest.approx(2.5)


def test_verdict_and_table_of_the_prior_agree_on_what_the_data_decide(results):
    """The prior's table has a number by "prior" exactly where the verdict has it undecided."""
    platform = made_up.platform(prior="hand_measured")
    ratio = np.sqrt([0.5, 0.5, 0.9, 0.1, 0.1, 0.1])  # of the sigmas, with the prior counted in: weights 0.5, 0.1, 0.9
    hand = platform.hand_measured
    wide = np.diag(ratio) @ hand.covariance @ np.diag(ratio)
    pose = PoseWithCovariance(hand.pose, wide)
    calibration = dataclasses.replace(results, platform=platform)
    vars(calibration)["estimate"] = pose
    table = prior_table(pose.pose, pose.covariance, platform.hand_measurement(), True).set_index("parameter")
    assert table.loc["r_z_m", "decided_by"] == "prior"
    evidence = gather_evidence(calibration)
    assert (evidence.undecided, evidence.decided_by_both) == (("r_z",), ("r_x", "r_y"))


def test_the_verdict_names_the_farthest_of_all_numbers_in_the_table(results):
    evidence, shown = gather_evidence(results), [*pose_numbers(results), *angles(results)]
    assert len(shown) == 9
    farthest = max(shown, key=lambda one: abs(one.difference_sigmas))
    assert (evidence.hand_parameter, evidence.hand_sigmas) == (farthest.name, abs(farthest.difference_sigmas))


def test_tilt_spread_of_level_observations_is_zero():
    table = made_up.observations().assign(roll_rad=0.0, pitch_rad=0.0)
    assert tilt_spread_deg(survey_from_table(table)) == pytest.approx(0.0, abs=1e-12)


def test_a_picture_keeps_its_colours_closely(tmp_path):
    original = np.zeros((40, 60, 3), dtype=np.uint8)
    original[:, :20], original[:, 20:40] = (0, 114, 178), (213, 94, 0)
    Image.fromarray(original).save(tmp_path / "flag.png")
    picture = embedded(tmp_path / "flag.png")
    with Image.open(io.BytesIO(base64.b64decode(picture.address.split(",")[1]))) as image:
        shown = np.asarray(image.convert("RGB")).astype(int)
    assert np.abs(shown - original).max() <= 8


def test_a_broken_picture_is_named(tmp_path):
    (tmp_path / "broken.png").write_bytes(b"\x89PNG broken")
    with pytest.raises(InputError, match=r"broken\.png"):
        embedded(tmp_path / "broken.png")
