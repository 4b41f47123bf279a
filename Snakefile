# linepose: from what camera and navigation system recorded to the camera's pose. A table of contents.

from snakemake.utils import min_version

min_version("9.0")


configfile: "config/config.yaml"


container: None


report: "workflow/report/workflow.rst"


include: "workflow/rules/runs.smk"
include: "workflow/rules/common.smk"
include: "workflow/rules/inputs.smk"
include: "workflow/rules/simulation.smk"
include: "workflow/rules/calibration.smk"
include: "workflow/rules/experiments.smk"


if Path("config/paper").is_dir():

    include: "workflow/rules/paper.smk"


include: "workflow/rules/outputs.smk"


rule all:
    default_target: True
    input:
        [file for platform in PLATFORMS for file in results_of(platform)],
        expand("results/{platform}/report.html", platform=PLATFORMS),
        "results/report.html",
        PAPER_RESULTS,
