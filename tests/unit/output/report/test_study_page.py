"""The study's page: every platform that has results in short, with links, whichever run made them."""

import json
from dataclasses import replace

import pytest

from linepose.errors import InputError
from linepose.output.report.page import render_study_page
from linepose.output.report.provenance import settings_text, versions
from linepose.output.report.summary_file import read_summary, summaries_on_disk, write_summary
from linepose.pipeline.summary import summarise


def page_of(*summaries):
    return render_study_page(summaries, settings_text({"seed": 1}), versions(), {"Another page": "another.html"})


def test_every_platform_has_its_card_and_links_to_its_page(results):
    summary = summarise(results)
    page = page_of(summary, replace(summary, name="other"))
    assert page.count('href="made-up/report.html"') == page.count('href="other/report.html"') == 2
    assert 'href="another.html"' in page
    assert "Use this pose with care: look at 4 of 9 checks." in page
    assert "The chain has 20 steps where 200 are needed. <strong>Set sampling.n_steps to 200" in page


def test_what_is_read_back_makes_the_same_page(results, tmp_path):
    summary = summarise(results)
    path = tmp_path / "summary.json"
    write_summary(summary, path)
    assert page_of(read_summary(path)) == page_of(summary)
    assert json.loads(path.read_text())["name"] == "made-up"


def test_platforms_on_disk_are_those_with_a_page(tmp_path):
    for name, files in {"a": ["summary.json", "report.html"], "b": ["summary.json"], "tables": ["x.csv"]}.items():
        (tmp_path / name).mkdir()
        for file in files:
            (tmp_path / name / file).touch()
    assert summaries_on_disk(tmp_path) == {"a": tmp_path / "a" / "summary.json"}


@pytest.mark.parametrize("text", ["", "{}", "[1]", '{"verdict": {"checks": 3}}'])
def test_another_file_is_named(tmp_path, text):
    path = tmp_path / "robot" / "summary.json"
    path.parent.mkdir()
    path.write_text(text)
    with pytest.raises(InputError, match=r"summary.json: found .*run `linepose run robot` again"):
        read_summary(path)
