"""All that a run is configured by: the study, its platforms, its data sets and the folders they are in."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from linepose.config.platform import Platform, load_platform
from linepose.config.platform_patterns import named_platforms
from linepose.config.study import DatasetSection, Study, check_study, load_dataset
from linepose.errors import InputError
from linepose.survey.datasets import find_dataset

CONFIG: Final = Path("config") / "config.yaml"


@dataclass(frozen=True)
class Project:
    """A checked configuration; `folders` says where each data set was found, or will be downloaded to.

    `platforms` has those of the study first, then those that only an experiment compares with.
    A data set that `datasets` does not list has no sums: it is the user's own, found in a data folder.
    `unavailable` names the data sets that are in no data folder and, as the study is offline, are not downloaded; their
    platforms are not in `platforms`.
    """

    study: Study
    platforms: Mapping[str, Platform]
    datasets: Mapping[str, DatasetSection]
    folders: Mapping[str, Path]
    unavailable: tuple[str, ...] = ()

    @property
    def covered(self) -> list[str]:
        """Names of the platforms that the coverage study simulates."""
        return self.study.coverage.platforms or [name for name in self.simulated if name in self.study.platforms]

    @property
    def simulated(self) -> list[str]:
        """Names of the platforms with a known truth that see a pattern."""
        return [name for name, platform in self.platforms.items() if platform.simulation is not None]

    @property
    def flown(self) -> list[str]:
        """Names of the platforms with a known truth that see the ground from the air."""
        return [name for name, platform in self.platforms.items() if platform.flight is not None]

    def files(self, dataset: str) -> list[Path]:
        """Every file of a data set that its platforms read."""
        folder = self.folders[dataset]
        if dataset in self.datasets:
            return [folder / file for file in self.datasets[dataset].sha256]
        sources = [platform.source for platform in self.platforms.values() if platform.source.dataset == dataset]
        return sorted({path for source in sources for path in source.files(folder)})

    def check_files(self) -> None:
        """Raise InputError naming the first file that a platform's source names and that is not there.

        A public data set's files are not looked for: they may be downloaded.
        """
        for name, platform in self.platforms.items():
            dataset = platform.source.dataset
            if dataset is None or dataset in self.datasets:
                continue
            folder = self.folders[dataset]
            for path in sorted(platform.source.files(folder)):
                if not path.is_file():
                    named = _named_files(platform.source.model_dump(), "source")
                    key = next((key for key, file in named.items() if folder / file == path), "source")
                    found = "a folder" if path.is_dir() else "no such file"
                    expected = f"the file that {key} of platform {name} names"
                    raise InputError(str(path), found, expected, f"restore it, or correct {key}")

    def sums(self, dataset: str) -> dict[str, str | None]:
        """SHA-256 of each file of a data set by its path there, None for the user's own."""
        known = self.datasets[dataset].sha256 if dataset in self.datasets else {}
        folder = self.folders[dataset]
        paths = [path.relative_to(folder).as_posix() for path in self.files(dataset)]
        return {path: known.get(path) for path in paths}

    def folder(self, platform: str) -> Path:
        """Folder of what the platform recorded: its data set's, or that of the simulated survey."""
        dataset = self.platforms[platform].source.dataset
        return Path(f"results/{platform}/simulated") if dataset is None else self.folders[dataset]

    def record(self, platform: str) -> str:
        """The result that stands for all that the platform recorded: the checked sums, or the simulated survey."""
        dataset = self.platforms[platform].source.dataset
        return f"results/{platform}/simulated" if dataset is None else f"results/datasets/{dataset}.csv"


def _named_files(section: Mapping[str, Any], above: str) -> dict[str, str]:
    """Every text of a section and of those in it, by its key."""
    found = {f"{above}.{key}": value for key, value in section.items() if isinstance(value, str)}
    for key, value in section.items():
        if isinstance(value, Mapping):
            found |= _named_files(value, f"{above}.{key}")
    return found


Compared = Callable[[Platform, str], Sequence[str]]


def compared_with_none(platform: Platform, file: str) -> Sequence[str]:  # noqa: ARG001
    """For a project that is not asked for its experiments."""
    return ()


def load_project(values: dict[str, Any], root: Path, compared: Compared = compared_with_none) -> Project:
    """The project that config.yaml's values and the files they name describe, patterns of platforms told by name.

    `compared` checks the experiments of a platform of which the file is named too, and names the platforms that they
    compare it with: `linepose.experiments.registry.compared_platforms`. In an offline study, a data set that is in no
    data folder is unavailable: its platforms are left out, as long as others remain. Raises InputError for the first
    key, file or name that is wrong.
    """
    study = check_study(values)
    names = named_platforms(study.platforms, root / study.platforms_folder)
    study = study.model_copy(update={"platforms": names})
    platforms = {name: load_platform(root / study.platforms_folder, name) for name in study.platforms}
    for name, platform in list(platforms.items()):
        for other in compared(platform, str(root / study.platforms_folder / f"{name}.yaml")):
            platforms.setdefault(other, load_platform(root / study.platforms_folder, other))
    for name in study.coverage.platforms:
        if name not in study.platforms or platforms[name].simulation is None:
            raise InputError(
                "config/config.yaml: coverage.platforms",
                f"{name}, not a simulated platform of this study",
                "names under `platforms` whose file has a simulation",
                "name it there, or leave the list empty for all of them",
            )
    datasets = {name: load_dataset(root / sums) for name, sums in study.datasets.items()}
    searched = [root / folder for folder in study.data_folders]
    folders = {}
    absent = []
    for name, platform in platforms.items():
        dataset = platform.source.dataset
        if dataset is None or dataset in folders:
            continue
        known = list(datasets[dataset].sha256) if dataset in datasets else []
        found = find_dataset(dataset, known, searched)
        if found is None and dataset not in datasets:
            raise InputError(
                f"{root / study.platforms_folder / name}.yaml: source.dataset",
                f"no folder {dataset} in {', '.join(study.data_folders)}",
                "a folder with the platform's files",
                f"put them in {searched[0] / dataset}",
            )
        folders[dataset] = found or searched[0] / dataset
        if found is None and study.offline:
            absent.append(dataset)
    remaining = {name: platform for name, platform in platforms.items() if platform.source.dataset not in absent}
    if absent and remaining:
        return Project(study, remaining, datasets, folders, tuple(absent))
    return Project(study, platforms, datasets, folders)
