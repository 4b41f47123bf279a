"""Where the workflow stands that a project is run with."""

from pathlib import Path

from linepose.errors import InputError


def find_workflow(root: Path) -> Path:
    """The Snakefile of a project, or of the clone that this package runs from; raises InputError if none."""
    clone = Path(__file__).parents[3]
    for folder in (root, clone):
        if (folder / "Snakefile").is_file() and (folder / "workflow" / "rules").is_dir():
            return folder / "Snakefile"
    raise InputError(
        str(root),
        "no Snakefile",
        "a clone of linepose, which brings the workflow",
        "clone the repository and put this project's config/ and data/ there; without the workflow, "
        "linepose.calibrate_platform(NAME) in Python gives pose and sigmas (docs/api.md)",
    )
