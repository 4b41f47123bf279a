"""The documentation site: `make docs`. Pages are Markdown; the reference is made from the docstrings."""

from typing import Any, Final

import linepose

project = "linepose"
author = "The linepose developers"
copyright = author
release = linepose.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "numpydoc"]
root_doc = "index"
html_theme = "furo"
html_title = f"linepose {release}"
html_copy_source = False
html_show_sphinx = False
exclude_patterns = ["images"]

myst_heading_anchors = 3
nitpicky = True

autodoc_member_order = "groupwise"
autodoc_typehints = "none"
autodoc_default_options = {"exclude-members": "model_config"}
numpydoc_show_class_members = False

_PAGES_OF_THE_ROOT: Final = {"CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md"}


def lead_to_site(_app: Any, _path: Any, _page: str, content: list[str]) -> None:
    """Links between the pages of the repository's root, which the site includes, led to the site's pages."""
    for file, page in _PAGES_OF_THE_ROOT.items():
        content[0] = content[0].replace(f"]({file})", f"](docs/{page})")


def setup(app: Any) -> None:
    """Let links of included pages be led."""
    app.connect("include-read", lead_to_site)
