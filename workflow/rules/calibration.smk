# From observations to the pose and its uncertainty.

OBSERVED = {  # what each stage of the removal is estimated from
    "observations": "results/{platform}/observations.parquet",
    "outliers": "results/{platform}/outliers.parquet",
    "compiled": compiled,
}


rule compile:
    output:
        "results/compiled/{noise_model}.txt",
    log:
        "results/logs/compile_{noise_model}.log",
    conda:
        "../../environment.yml"
    resources:
        **LIGHT,
    params:
        code=script_digest("compile"),
    script:
        "../../scripts/compile.py"


rule adjust:  # all at once: no observation is removed, and the posterior needs no chain
    input:
        observations="results/{platform}/observations.parquet",
        known=known_points,
        compiled=compiled,
        lost=remade_if_lost("results/{platform}/mcmc"),
    output:
        **{
            name: f"results/{{platform}}/{name}.parquet"
            for name in (*STAGES, *ADJUSTED)
        },
        samples=directory("results/{platform}/mcmc"),
        files="results/{platform}/mcmc_files.txt",
    log:
        "results/logs/{platform}/adjust.log",
    wildcard_constraints:
        platform=names_of(ADJUSTED_PLATFORMS),
    conda:
        "../../environment.yml"
    resources:
        **LIGHT,
    params:
        platform=settings,
        adjustment=section("adjustment"),
        seed=STUDY.seed,
        code=script_digest("adjust"),
    script:
        "../../scripts/adjust.py"


rule reject_outliers:
    input:
        observations="results/{platform}/observations.parquet",
        compiled=compiled,
    output:
        "results/{platform}/outliers.parquet",
    log:
        "results/logs/{platform}/reject_outliers.log",
    wildcard_constraints:
        platform=names_of(REMOVING_PLATFORMS),
    conda:
        "../../environment.yml"
    resources:
        **LIGHT,
    params:
        platform=settings,
        outliers=section("outliers"),
        search=section("search"),
        code=script_digest("reject_outliers"),
    script:
        "../../scripts/reject_outliers.py"


rule optimise:
    input:
        **OBSERVED,
    output:
        "results/{platform}/optima.parquet",
    log:
        "results/logs/{platform}/optimise.log",
    wildcard_constraints:
        platform=names_of(REMOVING_PLATFORMS),
    conda:
        "../../environment.yml"
    resources:
        **LIGHT,
    params:
        platform=settings,
        search=section("search"),
        code=script_digest("optimise"),
    script:
        "../../scripts/optimise.py"


rule sample:
    input:
        **OBSERVED,
        optima="results/{platform}/optima.parquet",
        lost=remade_if_lost("results/{platform}/mcmc"),
    output:
        samples=directory("results/{platform}/mcmc"),
        files="results/{platform}/mcmc_files.txt",
    log:
        "results/logs/{platform}/sample.log",
    wildcard_constraints:
        platform=names_of(REMOVING_PLATFORMS),
    conda:
        "../../environment.yml"
    threads: 2
    resources:
        **LIGHT,
    params:
        platform=settings,
        sampling=section("sampling"),
        seed=STUDY.seed,
        code=script_digest("sample"),
    script:
        "../../scripts/sample.py"


rule diagnose:
    input:
        optima="results/{platform}/optima.parquet",
        samples="results/{platform}/mcmc",
    output:
        diagnostics="results/{platform}/diagnostics.parquet",
        pose="results/{platform}/pose.parquet",
    log:
        "results/logs/{platform}/diagnose.log",
    wildcard_constraints:
        platform=names_of(REMOVING_PLATFORMS),
    conda:
        "../../environment.yml"
    resources:
        **LIGHT,
    params:
        platform=settings,
        sampling=section("sampling"),
        code=script_digest("diagnose"),
    script:
        "../../scripts/diagnose.py"


rule residuals:
    input:
        **OBSERVED,
        optima="results/{platform}/optima.parquet",
    output:
        residuals="results/{platform}/residuals.parquet",
        points="results/{platform}/estimated_points.parquet",
    log:
        "results/logs/{platform}/residuals.log",
    wildcard_constraints:
        platform=names_of(REMOVING_PLATFORMS),
    conda:
        "../../environment.yml"
    resources:
        **LIGHT,
    params:
        platform=settings,
        code=script_digest("residuals"),
    script:
        "../../scripts/residuals.py"
