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
        experiments=figure_inputs,
        record=record,
        lost=remade_if_lost("results/{platform}/figures"),
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
    benchmark:
        "results/benchmarks/{platform}/figures.tsv"
    conda:
        "../../environment.yml"
    resources:
        **LIGHT,
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
        samples="results/{platform}/mcmc",
        figures="results/{platform}/figures",
    output:
        page=report(
            "results/{platform}/report.html",
            caption="../report/report.rst",
            category="{platform}",
            labels={"result": "summary of the platform"},
        ),
        summary="results/{platform}/summary.json",
    log:
        "results/logs/{platform}/report.log",
    conda:
        "../../environment.yml"
    resources:
        **LIGHT,
    params:
        platform=lambda wildcards: PROJECT.platforms[wildcards.platform].model_dump(
            mode="json"
        ),
        study=STUDY.model_dump(mode="json", exclude={"platforms"}),
        code=script_digest("report"),
    script:
        "../../scripts/report.py"


rule study_report:
    input:
        expand("results/{platform}/summary.json", platform=PLATFORMS),
    output:
        report(
            "results/report.html",
            caption="../report/study_report.rst",
            category="Report",
            labels={"result": "summary of all platforms"},
        ),
    log:
        "results/logs/study_report.log",
    conda:
        "../../environment.yml"
    resources:
        **LIGHT,
    params:
        others=other_summaries,
        study=STUDY.model_dump(mode="json", exclude={"platforms"}),
        further_pages=FURTHER_PAGES,
        code=script_digest("study_report"),
    script:
        "../../scripts/study_report.py"
