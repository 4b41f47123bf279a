"""Build the wheel with the workflow, of which the repository has one copy, in the package's folder `workflow`."""

from pathlib import Path
from shutil import rmtree
from typing import Final

from setuptools import setup
from setuptools.command.build_py import build_py

CARRIED: Final = (
    "Snakefile",
    "environment.yml",
    "workflow/rules/*.smk",
    "workflow/report/*.rst",
    "scripts/*.py",
    "profiles/*/*.yaml",
)


class BuildWithWorkflow(build_py):
    """The package's modules, and the files that run it; an editable installation takes these from the clone."""

    def run(self) -> None:
        """Copy both into the folder from which the wheel is made."""
        super().run()
        if self.editable_mode:
            return
        root = Path(__file__).parent
        rmtree(Path(self.build_lib, "linepose", "workflow"), ignore_errors=True)  # of an earlier build
        for source in sorted(path for pattern in CARRIED for path in root.glob(pattern)):
            target = Path(self.build_lib, "linepose", "workflow", source.relative_to(root))
            target.parent.mkdir(parents=True, exist_ok=True)
            self.copy_file(str(source), str(target))


setup(cmdclass={"build_py": BuildWithWorkflow})
