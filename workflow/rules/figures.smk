rule figures:
    input:
        observations="results/{platform}/observations.parquet",
        outliers="results/{platform}/outliers.parquet",
        samples="results/{platform}/mcmc",
        pose="results/{platform}/pose.parquet",
        diagnostics="results/{platform}/diagnostics.parquet",
        uncertainty="results/{platform}/uncertainty.parquet",
        residuals="results/{platform}/residuals.parquet",
        points="results/{platform}/estimated_points.parquet",
        experiments=drawn_from,
        record=lambda wildcards: PROJECT.record(wildcards.platform),
    output:
        report(
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
        folder=lambda wildcards: str(PROJECT.folder(wildcards.platform)),
        code=script_digest("figures"),
    script:
        "../../scripts/figures.py"
