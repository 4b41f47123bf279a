rule published_tables:
    input:
        published=STUDY.published,
        sigma=f"results/{COMPARED[0]}/navigation_sigma.parquet" if COMPARED else [],
        pose=f"results/{COMPARED[0]}/pose.parquet" if COMPARED else [],
        subsets=f"results/{COMPARED[0]}/subsets.parquet" if COMPARED else [],
        repeatability=f"results/{COMPARED[0]}/repeatability.parquet" if COMPARED else [],
    output:
        expand(
            "results/tables/table{number}.{kind}",
            number=[2, 3, 4, 5],
            kind=["parquet", "md"],
        ),
        *(
            report(
                f"results/tables/table{number}.csv",
                caption="../report/table.rst",
                category="Report",
                labels={"result": f"Table {number}, published and obtained"},
            )
            for number in [2, 3, 4, 5]
        ),
    log:
        "results/logs/published_tables.log",
    conda:
        "../../environment.yml"
    params:
        platform=COMPARED[0] if COMPARED else "",
        folder=lambda wildcards, output: str(Path(output[0]).parent),
        code=script_digest("published_tables"),
    script:
        "../../scripts/published_tables.py"
