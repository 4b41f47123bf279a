"""The study's page: every platform that has results in short, with links, whichever run made them."""

import json
from dataclasses import replace

import pytest

from linepose.errors import InputError
from linepose.output.report.page import render_study_page, worst_first
from linepose.output.report.provenance import settings_text, versions
from linepose.output.report.summary_file import read_summary, summaries_on_disk, write_summary
from linepose.pipeline.checks import Level
from linepose.pipeline.summary import summarise
from linepose.pipeline.verdict import Verdict


def page_of(*summaries):
    return render_study_page(summaries, settings_text({"seed": 1}), versions(), {"Another page": "another.html"})


def test_every_platform_has_its_card_and_links_to_its_page(results):
    summary = summarise(results)
    page = page_of(summary, replace(summary, name="other"))
    assert page.count('href="made-up/report.html"') == page.count('href="other/report.html"') == 2
    assert 'href="another.html"' in page
    assert "Use this pose with care: look at 4 of 9 checks." in page
    assert "The chain has 20 steps where 200 are needed. <strong>Set sampling.n_steps to 200" in page


def test_platforms_that_need_a_look_come_first_with_the_reason(results):
    care = summarise(results)
    assert care.verdict.level == Level.CARE
    bad = replace(care.verdict.checks[0], level=Level.BAD, brief="the pose is far off")
    good = replace(care, name="a", verdict=Verdict(Level.GOOD, "Use this pose.", ()))
    worse = replace(care, name="z", verdict=Verdict(Level.BAD, "Do not use this pose yet.", (bad, bad)))
    worst = replace(care, name="zz", verdict=Verdict(Level.BAD, "Do not use this pose yet.", (bad, bad, bad)))
    ordered = worst_first([good, worse, care, worst])
    assert [one.name for one in ordered] == ["zz", "z", "made-up", "a"]
    page = page_of(*ordered)
    places = [page.index(f'<a href="#{name}-overview">') for name in ("zz", "z", "made-up", "a")]
    assert places == sorted(places)
    assert "the pose is far off, and 1 more" in page
    assert "every check passed" in page
    assert "those that need a look first" not in page_of(care)


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
