"""The page of published and obtained numbers, one HTML file that needs no network."""

from collections.abc import Sequence

from linepose.output.report.page import page_environment
from linepose.output.report.sections import SectionOnPage


def render_paper_page(sections: Sequence[SectionOnPage], left_out: Sequence[str] = ()) -> str:
    """The whole page of the sections, in the report's style; `left_out` names the platforms whose data are not here."""
    template = page_environment("linepose.paper").get_template("paper.html.j2")
    return template.render(sections=sections, left_out=left_out)
