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
        conda:
            "../../environment.yml"
        params:
            dataset=key,
            searched=STUDY.data_folders,
            code=script_digest("fetch"),
        script:
            "../../scripts/fetch.py"
