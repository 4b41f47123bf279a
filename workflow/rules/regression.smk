from linepose.paper.experiments_regression import BASIN_ROWS_OF

REGRESSED = {
    key: PROJECT.platforms[key].published
    for key in PLATFORMS
    if PROJECT.platforms[key].published
    and PROJECT.platforms[key].noise_model == "published"
}

# Those with a known truth, and the sigmas that their points' extraction is held to.
REGRESSED_ON_TRUTH = {
    key: PROJECT.platforms[key].camera.sigmas.model_dump(include={"u_px", "v_px"})
    for key in REGRESSED
    if key in PROJECT.simulated
}

# Platforms with all experiments that the paper has numbers of.
COMPARED = [
    key
    for key, published in REGRESSED.items()
    if published == "ladybird"
    and {"high", "low"} <= set(PROJECT.platforms[key].experiments.subsets)
    and PROJECT.platforms[key].experiments.repeatability
    and PROJECT.platforms[key].experiments.repeatability.first
]
SWEPT = [
    key
    for key, published in REGRESSED.items()
    if published in BASIN_ROWS_OF
    and PROJECT.platforms[key].experiments.basin
    and "powell" in PROJECT.platforms[key].experiments.basin.optimisers
]


rule regression:
    input:
        published=STUDY.published,
        subsets=expand("results/{platform}/subsets.parquet", platform=COMPARED),
        pairs=expand("results/{platform}/repeatability.parquet", platform=COMPARED),
        basin=expand("results/{platform}/basin_summary.parquet", platform=SWEPT),
        pose=expand("results/{platform}/pose.parquet", platform=REGRESSED),
        outliers=expand("results/{platform}/outliers.parquet", platform=REGRESSED),
        sigma=expand("results/{platform}/navigation_sigma.parquet", platform=REGRESSED),
        truth=expand("results/{platform}/truth.parquet", platform=REGRESSED_ON_TRUTH),
        truth_error=expand(
            "results/{platform}/truth_error.parquet", platform=REGRESSED_ON_TRUTH
        ),
        accuracy=expand(
            "results/{platform}/extraction_accuracy.parquet",
            platform=REGRESSED_ON_TRUTH,
        ),
        detection=expand(
            "results/{platform}/detection.parquet", platform=REGRESSED_ON_TRUTH
        ),
    output:
        parquet="results/regression.parquet",
        csv=report(
            "results/regression.csv",
            caption="../report/regression.rst",
            category="Report",
            labels={"result": "published and obtained numbers"},
        ),
    log:
        "results/logs/regression.log",
    conda:
        "../../environment.yml"
    params:
        published_as=REGRESSED,
        compared=COMPARED,
        swept=SWEPT,
        on_truth=REGRESSED_ON_TRUTH,
        code=script_digest("regression"),
    script:
        "../../scripts/regression.py"


rule check_regression:
    input:
        "results/regression.parquet",
    output:
        touch("results/logs/regression.passed"),
    log:
        "results/logs/check_regression.log",
    conda:
        "../../environment.yml"
    params:
        code=script_digest("check_regression"),
    script:
        "../../scripts/check_regression.py"
