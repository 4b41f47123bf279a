# What people read: figures and reports.


def figure_labels(wildcards):
    """A figure's title and its number in the paper, for Snakemake's report."""
    index = read_table(f"results/{wildcards.platform}/figures/index.parquet")
    entry = index.set_index("figure").loc[wildcards.figure]
    return {"figure": entry["title"], "paper": entry["paper_figure"] or "beyond it"}


def drawn_from(wildcards):
    """The results that a platform's figures are drawn from, beside those that every platform has."""
    detected = (
        [f"results/{wildcards.platform}/detected_points.parquet"]
        if wildcards.platform in PROJECT.simulated
        else []
    )
    return experiment_results(wildcards.platform) + detected


rule figures:
    input:
        observations="results/{platform}/observations.parquet",
        outliers="results/{platform}/outliers.parquet",
        samples="results/{platform}/mcmc",
        pose="results/{platform}/pose.parquet",
        diagnostics="results/{platform}/diagnostics.parquet",
        residuals="results/{platform}/residuals.parquet",
        points="results/{platform}/estimated_points.parquet",
        experiments=drawn_from,
        record=record,
    output:
        files="results/{platform}/figures_files.txt",
        figures=report(
            directory("results/{platform}/figures"),
            patterns=["{figure}.png"],
            caption="../report/figure.rst",
            category="{platform}",
            subcategory="Figures",
            labels=figure_labels,
        ),
    log:
        "results/logs/{platform}/figures.log",
    conda:
        "../../environment.yml"
    params:
        platform=lambda wildcards: PROJECT.platforms[wildcards.platform].model_dump(
            mode="json"
        ),
        outliers=section("outliers"),
        folder=recorded_folder,
        code=script_digest("figures"),
    script:
        "../../scripts/figures.py"


def reported(_):
    """Every result that the report's summaries and sections rest on."""
    always = ["observations", "outliers", "optima", "pose", "diagnostics", "residuals"]
    return [
        file for platform in PLATFORMS for file in experiment_results(platform)
    ] + expand("results/{platform}/{name}.parquet", platform=PLATFORMS, name=always)


rule report:
    input:
        results=reported,
        samples=expand("results/{platform}/mcmc", platform=PLATFORMS),
        figures=expand("results/{platform}/figures", platform=PLATFORMS),
    output:
        report(
            "results/report.html",
            caption="../report/report.rst",
            category="Report",
            labels={"result": "summary of all platforms"},
        ),
    log:
        "results/logs/report.log",
    conda:
        "../../environment.yml"
    params:
        platforms={
            name: PROJECT.platforms[name].model_dump(mode="json") for name in PLATFORMS
        },
        study=STUDY.model_dump(mode="json"),
        further_pages=FURTHER_PAGES,
        code=script_digest("report"),
    script:
        "../../scripts/report.py"
