# linepose: from what camera and navigation system recorded to the camera's pose. A table of contents.

from snakemake.utils import min_version

min_version("9.0")


configfile: "config/config.yaml"


container: None


report: "workflow/report/workflow.rst"


include: "workflow/rules/common.smk"
include: "workflow/rules/fetch.smk"
include: "workflow/rules/compile.smk"
include: "workflow/rules/check_data.smk"
include: "workflow/rules/check_readable.smk"
include: "workflow/rules/simulate.smk"
include: "workflow/rules/extract.smk"
include: "workflow/rules/measure_extraction.smk"
include: "workflow/rules/associate.smk"
include: "workflow/rules/reject_outliers.smk"
include: "workflow/rules/optimise.smk"
include: "workflow/rules/sample.smk"
include: "workflow/rules/diagnose.smk"
include: "workflow/rules/residuals.smk"
include: "workflow/rules/experiments.smk"
include: "workflow/rules/coverage.smk"
include: "workflow/rules/figures.smk"


if os.path.isdir("config/paper"):

    include: "workflow/rules/paper.smk"


include: "workflow/rules/report.smk"


rule all:
    default_target: True
    input:
        [file for platform in PLATFORMS for file in results_of(platform)],
        "results/report.html",
        PAPER_RESULTS,
