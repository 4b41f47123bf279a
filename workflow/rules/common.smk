from hashlib import sha256
from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.logging import logger

from linepose.config.map import MAP_RESULTS
from linepose.config.project import load_project
from linepose.errors import LineposeError
from linepose.estimation.noise_models import noise_model
from linepose.experiments.registry import (
    EXPERIMENTS,
    compared_platforms,
    wanted_experiments,
)
from linepose.inputs.source import ScansSection
from linepose.output.report.summary_file import summaries_on_disk
from linepose.pipeline import code_digest, sections
from linepose.pipeline.adjusted_schemas import ADJUSTED, STAGES
from linepose.pipeline.file_list import lost_files
from linepose.tables import read_table

try:
    PROJECT = load_project(config, Path(), compared_platforms)
except LineposeError as error:
    raise WorkflowError(str(error)) from None

if PROJECT.unavailable and workflow.is_main_process:
    logger.warning(
        f"linepose: data set {', '.join(PROJECT.unavailable)}: not in {', '.join(PROJECT.study.data_folders)}, and `offline` "
        f"forbids to download it; only the other platforms run: {', '.join(PROJECT.platforms)}"
    )

STUDY = PROJECT.study
SCRIPTS = (
    Path(str(workflow.current_basedir)).parents[1] / "scripts"
)  # themselves, not copies

PLATFORMS = [name for name in STUDY.platforms if name in PROJECT.platforms]
REMOVING_PLATFORMS = [
    name
    for name, one in PROJECT.platforms.items()
    if noise_model(one.noise_model).removes_outliers
]
ADJUSTED_PLATFORMS = [
    name for name in PROJECT.platforms if name not in REMOVING_PLATFORMS
]
KNOWING_PLATFORMS = [  # that know something of their points
    name for name, one in PROJECT.platforms.items() if one.knows_points
]
MAPPED_PLATFORMS = [  # whose file asks for their scans on the map
    name
    for name, one in PROJECT.platforms.items()
    if one.map is not None and isinstance(one.source, ScansSection)
]
PAPER_RESULTS = []  # what `rule all` makes of the paper, where config/paper exists
FURTHER_PAGES = {}  # that the report links to: title and address


scattergather:
    coverage=4,  # parts of a cell of the coverage study
    maps=1,  # jobs that put a platform's scans on the map


wildcard_constraints:
    platform="[A-Za-z0-9_.-]+",


def names_of(platforms):
    """A pattern that these names fit and no other."""
    return "|".join(platforms) or "[^\\s\\S]"


WARNED = set()  # of these folders' losses, once a run


def remade_if_lost(folder):
    """No input, but a folder of results from which a file was lost is made again, as by --forcerun with its list.

    Snakemake asks for a rule's inputs before it decides what to run. Nothing on disk is changed, so that a dry run
    plans what a run does.
    """

    def no_input(wildcards):
        name = folder.format(**wildcards)
        lost = lost_files(Path(name), Path(f"{name}_files.txt"))
        if lost and workflow.is_main_process and workflow.dag is not None:
            workflow.dag.forcefiles.add(f"{name}_files.txt")
            if name not in WARNED:
                WARNED.add(name)
                logger.warning(
                    f"linepose: {name}: {', '.join(lost)} lost; the folder is made again"
                )
        return []

    return no_input


def settings_of(platform):
    """What a platform's file says that numbers depend on."""
    return sections.platform_section(PROJECT, platform)


def settings(wildcards):
    """What the platform's file says, as a rule's parameter: a change of it runs the rule again."""
    return settings_of(wildcards.platform)


def mapped_settings(wildcards):
    """What the platform's file says that its maps depend on."""
    return PROJECT.platforms[wildcards.platform].model_dump(
        mode="json", exclude={"description", "experiments", "outline"}
    )


def map_results(platform):
    """What the maps of a platform's scans are, where its file asks for them."""
    if platform not in MAPPED_PLATFORMS:
        return []
    return [f"results/{platform}/{name}.parquet" for name in MAP_RESULTS]


def experiment_results(platform):
    """The results of all experiments that are run for a platform."""
    return [
        f"results/{platform}/{name}.parquet"
        for one in wanted_experiments(PROJECT.platforms[platform])
        for name in one.outputs
    ]


def adjusted_results(platform):
    """What the errors were, of a platform whose noise model is the adjustment."""
    if platform in REMOVING_PLATFORMS:
        return []
    return [f"results/{platform}/{name}.parquet" for name in ADJUSTED]


def results_of(platform):
    """Every result of a platform, so that whichever of them is lost is made again."""
    names = ["points.parquet", "observations.parquet", "navigation_sigma.parquet"]
    names += ["map_frame.parquet", "outliers.parquet", "optima.parquet"]
    names += ["mcmc_files.txt", "pose.parquet", "diagnostics.parquet"]
    names += ["residuals.parquet", "estimated_points.parquet", "figures_files.txt"]
    if platform in ADJUSTED_PLATFORMS:
        names += [f"{name}.parquet" for name in ADJUSTED]
    if platform in PROJECT.simulated + PROJECT.flown:
        names += ["simulated_files.txt", "truth.parquet"]
    if platform in PROJECT.simulated:
        names += ["detection.parquet", "extraction_accuracy.parquet"]
        names += ["detected_points.parquet"]
    if platform in MAPPED_PLATFORMS:
        names += ["map_files.txt"]
    return (
        experiment_results(platform)
        + map_results(platform)
        + [f"results/{platform}/{name}" for name in names]
    )


def record(wildcards):
    """The result that stands for all that the platform recorded."""
    return PROJECT.record(wildcards.platform)


def recorded_folder(wildcards):
    """The folder of what the platform recorded, as a rule's parameter."""
    return str(PROJECT.folder(wildcards.platform))


def map_frame(wildcards):
    """Where the platform's file says that its survey lies, as a rule's parameter; None where it does not."""
    section = PROJECT.platforms[wildcards.platform].map_frame
    return None if section is None else section.model_dump(mode="json")


def known_points(wildcards):
    """What is known of the platform's points; nothing where its file says nothing of them."""
    if wildcards.platform not in KNOWING_PLATFORMS:
        return []
    return f"results/{wildcards.platform}/known_points.parquet"


def readable(wildcards):
    """The check of what the platform recorded; what was simulated here needs none."""
    if wildcards.platform in PROJECT.simulated + PROJECT.flown:
        return []
    return f"results/logs/{wildcards.platform}/check_readable.passed"


def compiled(wildcards):
    """The compiled kernel of the platform's noise model; the others may still be in the making."""
    return f"results/compiled/{PROJECT.platforms[wildcards.platform].noise_model}.txt"


def platform_file(wildcards):
    """The platform's file, for messages."""
    return f"{STUDY.platforms_folder}/{wildcards.platform}.yaml"


def section(key):
    """What config.yaml says under this key, as a rule's parameter."""
    return sections.study_section(PROJECT, key)


def script_digest(name, *modules):
    """Digest of a script's code, and of modules that it imports by name, as the rule's parameter `code`."""
    return code_digest.script_digest(SCRIPTS / f"{name}.py", *modules)


def experiment_inputs(experiment):
    """The files that an experiment's entry says it needs, by name."""
    files = {
        need: f"results/{{platform}}/{need}.parquet"
        for need in experiment.needs
        if need != "samples"
    }
    if "samples" in experiment.needs:
        files["samples"] = "results/{platform}/mcmc"
    if experiment.compares:
        for need in ("observations", "outliers"):
            files[f"other_{need}"] = result_of_compared(experiment, need)
    if experiment.log:
        files["record"] = record
    if experiment.noise_model:
        files["compiled"] = f"results/compiled/{experiment.noise_model}.txt"
    elif "observations" in experiment.needs:
        files["compiled"] = compiled
    return files


def result_of_compared(experiment, result):
    """This result of the platforms that an experiment compares a platform with."""
    return lambda wildcards: [
        f"results/{other}/{result}.parquet"
        for other in experiment.compared_with(PROJECT.platforms[wildcards.platform])
    ]


def experiment_parameters(experiment):
    """All that an experiment's entry says it takes from the configuration, as a rule's parameters."""

    def study(wildcards):
        return {key: section(key) for key in experiment.study}

    def others(wildcards):
        names = experiment.compared_with(PROJECT.platforms[wildcards.platform])
        return {name: settings_of(name) for name in names}

    def sections(wildcards):
        platform = PROJECT.platforms[wildcards.platform]
        return {one.key: one.values(platform) for one in experiment.sections}

    return {
        "platform": settings,
        "file": platform_file,
        "sections": sections,
        "study": study,
        "others": others,
        "folder": recorded_folder,
        "module": experiment.module,
        "code": script_digest("experiment", experiment.module),
        "work": f"results/{{platform}}/work/{experiment.name}",
    }


def covered_cells(_):
    """Every platform, regime and noise model of the coverage study."""
    cells = [
        f"results/coverage/cells/{platform}/{regime}/{model}.parquet"
        for platform in PROJECT.covered
        for regime, section in STUDY.coverage.regimes.items()
        for model in section.noise_models
    ]
    if not cells:
        raise WorkflowError(
            "config/config.yaml: coverage: found no regime or no simulated platform, expected at least one of each; "
            "add them under coverage.regimes and platforms"
        )
    return cells


def figure_labels(wildcards):
    """A figure's title, for Snakemake's report."""
    index = read_table(f"results/{wildcards.platform}/figures/index.parquet")
    return {"figure": index.set_index("figure").loc[wildcards.figure, "title"]}


def figure_inputs(wildcards):
    """The results that a platform's figures are drawn from, beside those that every platform has."""
    detected = (
        [f"results/{wildcards.platform}/detected_points.parquet"]
        if wildcards.platform in PROJECT.simulated
        else []
    )
    return (
        experiment_results(wildcards.platform)
        + adjusted_results(wildcards.platform)
        + map_results(wildcards.platform)
        + detected
    )


def reported(wildcards):
    """Every result of a platform that its page rests on."""
    always = ["observations", "outliers", "optima", "pose", "diagnostics", "residuals"]
    return (
        experiment_results(wildcards.platform)
        + adjusted_results(wildcards.platform)
        + map_results(wildcards.platform)
        + [f"results/{wildcards.platform}/{name}.parquet" for name in always]
    )


def other_summaries(_):
    """Digests of the summaries of platforms that other runs made: the study's page tells of them too."""
    return {
        name: sha256(path.read_bytes()).hexdigest()
        for name, path in summaries_on_disk(Path("results")).items()
        if name not in PLATFORMS
    }
