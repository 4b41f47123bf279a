"""How the page tells what is reproduced and what is not."""

import pandas as pd

from linepose.paper.page import render_paper_page
from linepose.paper.report_sections import published_sections
from unit import made_up

REGRESSION = pd.DataFrame(
    {
        "quantity": [
            "made-up, Table 3, r_x_m",
            "made-up, Table 3, r_y_m",
            "made-up, notebook, neg_log_likelihood",
            "other, planted fault 7 removed",
            "other, planted fault 9 removed",
        ],
        "published": [0.19, -0.10, 51.5, 1.0, 1.0],
        "obtained": [0.19, -0.14, 60.0, 1.0, 1.0],
        "tolerance": [0.01, 0.01, 0.1, 0.0, 0.0],
        "passed": [True, True, False, True, True],
        "expected": [None, -0.14, None, None, None],
        "expected_tolerance": [None, 0.001, None, None, None],
        "note": ["", "printed wrongly", "", "", ""],
    }
)


def test_published_numbers_are_grouped_with_their_outcome():
    differing, made_up_section, other = published_sections(REGRESSION, {})
    (table,) = differing.tables
    assert [row[0] for row in table.rows] == ["made-up, Table 3, r_y_m", "made-up, notebook, neg_log_likelihood"]
    assert [row[-1] for row in table.rows] == [
        "as declared, -0.14 ± 0.001: printed wrongly",
        "✗ differs",
    ]
    assert not table.folded
    assert differing.text.startswith("3 of 5 reproduced within the tolerance, 1 as declared, 1 not reproduced.")
    assert [(table.title, table.sentence) for table in made_up_section.tables] == [
        ("Table 3", "1 of 2 reproduced within the tolerance, 1 as declared."),
        ("notebook", "0 of 1 reproduced within the tolerance, 1 not reproduced."),
    ]
    (single,) = other.tables
    assert [row[0] for row in single.rows] == ["planted fault 7 removed", "planted fault 9 removed"]
    assert [row[-1] for row in single.rows] == ["✓ passed", "✓ passed"]


def test_notes_of_numbers_that_passed_stand_once_above_their_table():
    noted = REGRESSION.assign(note=["simulated", "printed wrongly", "", "simulated", "simulated"])
    _, made_up_section, other = published_sections(noted, {})
    assert made_up_section.tables[0].sentence.endswith("1 as declared. Simulated.")
    assert other.tables[0].sentence == "2 of 2 reproduced within the tolerance. Simulated."


def test_where_everything_is_reproduced_nothing_differs():
    reproduced = REGRESSION[REGRESSION["passed"] & REGRESSION["expected"].isna()]
    titles = [section.title for section in published_sections(reproduced, {})]
    assert titles == ["made-up", "other"]


def test_the_page_holds_every_section_and_table():
    page = render_paper_page(published_sections(REGRESSION, {"table3": made_up.pose()}))
    assert "made-up, notebook, neg_log_likelihood" in page
    assert 'id="published-what-differs"' in page
    assert 'id="table-table3"' in page
    assert "http" not in page.replace("http://www.w3.org", "")


def test_the_page_names_the_platforms_left_out():
    sections = published_sections(REGRESSION, {})
    assert "not held against the paper: field, other." in render_paper_page(sections, ["field", "other"])
    assert "Left out" not in render_paper_page(sections)


def test_a_deviation_other_than_declared_differs():
    other = REGRESSION.assign(passed=[True, False, True, True, True])
    table = published_sections(other, {})[0].tables[0]
    assert [row[-1] for row in table.rows] == ["✗ differs, -0.14 ± 0.001: printed wrongly"]
