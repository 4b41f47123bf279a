"""Options that several commands have."""

from pathlib import Path
from typing import Annotated

import typer

Name = Annotated[str, typer.Argument(metavar="NAME", help="The platform, as in config/platforms/NAME.yaml.")]
ProjectFolder = Annotated[
    Path,
    typer.Option(
        "--project", "-p", metavar="FOLDER", help="The project's folder, or one below it.", show_default="here"
    ),
]
HERE = Path()
