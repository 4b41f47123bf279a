# What people read: figures and reports.


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
