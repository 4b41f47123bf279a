for _name, _dataset in DATASETS.items():

    rule:
        name:
            f"fetch_{_name}"
        input:
            sums=STUDY.datasets[_name],
        output:
            expand(
                "{folder}/{file}",
                folder=Path(STUDY.data_folders[0]) / _name,
                file=_dataset.sha256,
            ),
        log:
            f"results/logs/fetch_{_name}.log",
        conda:
            "../../environment.yml"
        params:
            folder=str(Path(STUDY.data_folders[0]) / _name),
            searched=STUDY.data_folders,
            code=source_digest("linepose.datasets"),
        script:
            "../../scripts/fetch.py"
