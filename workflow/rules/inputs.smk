# What was recorded: had, checked, and turned into observations.


for key in PROJECT.datasets:

    rule:
        name:
            f"fetch_{key}"
        input:
            sums=STUDY.datasets[key],
        output:
            [
                f"{STUDY.data_folders[0]}/{key}/{file}"
                for file in PROJECT.datasets[key].sha256
            ],
        log:
            f"results/logs/fetch_{key}.log",
        localrule: True  # nodes of a cluster often reach no network
        conda:
            "../../environment.yml"
        resources:
            **LIGHT,
        params:
            dataset=key,
            searched=STUDY.data_folders,
            code=script_digest("fetch"),
        script:
            "../../scripts/fetch.py"


rule check_data:
    input:
        lambda wildcards: PROJECT.files(wildcards.dataset),
    output:
        "results/datasets/{dataset}.csv",
    log:
        "results/logs/check_data_{dataset}.log",
    conda:
        "../../environment.yml"
    resources:
        **LIGHT,
    params:
        folder=lambda wildcards: str(PROJECT.folders[wildcards.dataset]),
        sha256=lambda wildcards: PROJECT.sums(wildcards.dataset),
        code=script_digest("check_data"),
    script:
        "../../scripts/check_data.py"


rule check_readable:
    input:
        record,
    output:
        touch("results/logs/{platform}/check_readable.passed"),
    log:
        "results/logs/{platform}/check_readable.log",
    conda:
        "../../environment.yml"
    resources:
        **LIGHT,
    params:
        platform=settings,
        folder=recorded_folder,
        code=script_digest("check_readable"),
    script:
        "../../scripts/check_readable.py"


rule extract:
    input:
        record=record,
        readable=readable,
    output:
        "results/{platform}/points.parquet",
    log:
        "results/logs/{platform}/extract.log",
    conda:
        "../../environment.yml"
    resources:
        **LIGHT,
    params:
        platform=settings,
        folder=recorded_folder,
        code=script_digest("extract"),
    script:
        "../../scripts/extract.py"


rule associate:
    input:
        "results/{platform}/points.parquet",
    output:
        observations="results/{platform}/observations.parquet",
        sigma="results/{platform}/navigation_sigma.parquet",
        frame="results/{platform}/map_frame.parquet",
    log:
        "results/logs/{platform}/associate.log",
    conda:
        "../../environment.yml"
    resources:
        **LIGHT,
    params:
        platform=settings,
        folder=recorded_folder,
        code=script_digest("associate"),
    script:
        "../../scripts/associate.py"


rule know_points:
    input:
        observations="results/{platform}/observations.parquet",
        frame="results/{platform}/map_frame.parquet",
        record=record,
    output:
        "results/{platform}/known_points.parquet",
    log:
        "results/logs/{platform}/know_points.log",
    wildcard_constraints:
        platform=names_of(KNOWING_PLATFORMS),
    conda:
        "../../environment.yml"
    resources:
        **LIGHT,
    params:
        platform=settings,
        map_frame=map_frame,
        folder=recorded_folder,
        code=script_digest("know_points"),
    script:
        "../../scripts/know_points.py"
