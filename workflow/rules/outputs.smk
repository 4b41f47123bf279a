# What people take away and read: maps, figures and reports.


MAPPED = {  # what maps of scans rest on
    "pose": "results/{platform}/pose.parquet",
    "samples": "results/{platform}/mcmc",
    "points": "results/{platform}/estimated_points.parquet",
    "frame": "results/{platform}/map_frame.parquet",
    "adjusted": lambda wildcards: adjusted_results(wildcards.platform),
    "record": record,
}
MAP_PARTS = gather.maps("results/logs/{{platform}}/map_{scatteritem}.done")


rule map:  # finished scans stay in results/NAME/map when a run is killed, so that the next goes on
    input:
        **MAPPED,
        lost=remade_if_lost("results/{platform}/map"),
        parts=MAP_PARTS if len(MAP_PARTS) > 1 else [],
    output:
        budget="results/{platform}/map_budget.parquet",
        scans="results/{platform}/map_scans.parquet",
        files="results/{platform}/map_files.txt",
    log:
        "results/logs/{platform}/map.log",
    wildcard_constraints:
        platform=names_of(MAPPED_PLATFORMS),
    conda:
        "../../environment.yml"
    threads: workflow.cores or 1
    resources:
        **BATCHES,
    params:
        platform=mapped_settings,
        folder=recorded_folder,
        code=script_digest("map"),
    script:
        "../../scripts/map.py"


use rule map as map_part with:  # a share of the scans, as a job of its own: --set-scatter maps=N
    input:
        **MAPPED,
    output:
        temp("results/logs/{platform}/map_{scatteritem}.done"),
    log:
        "results/logs/{platform}/map_{scatteritem}.log",


rule strip_fit:
    input:
        **MAPPED,
    output:
        strip_patches="results/{platform}/strip_patches.parquet",
        strip_fit="results/{platform}/strip_fit.parquet",
    log:
        "results/logs/{platform}/strip_fit.log",
    wildcard_constraints:
        platform=names_of(MAPPED_PLATFORMS),
    conda:
        "../../environment.yml"
    resources:
        **LONG,
    params:
        platform=mapped_settings,
        folder=recorded_folder,
        code=script_digest("strip_fit"),
    script:
        "../../scripts/strip_fit.py"


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
