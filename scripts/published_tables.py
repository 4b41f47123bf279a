"""Put the paper's Tables 2-5 and the obtained numbers side by side."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.yaml_file import read_yaml
    from linepose.experiments.repeatability import REPEATABILITY
    from linepose.experiments.subsets import SUBSETS
    from linepose.paper.declarations import load_declarations
    from linepose.paper.tables import PUBLISHED_NAVIGATION, PUBLISHED_POSES, markdown, published_tables
    from linepose.pipeline.stages import POSE
    from linepose.survey.navigation import NAVIGATION_SIGMA
    from linepose.tables import atomic_write, read_table, write_csv, write_table

    tables = published_tables(
        *snakemake.params.platform,
        read_yaml(Path(snakemake.input.published)),
        read_table(snakemake.input.sigma[0], NAVIGATION_SIGMA),
        read_table(snakemake.input.pose[0], POSE),
        read_table(snakemake.input.subsets[0], SUBSETS),
        read_table(snakemake.input.repeatability[0], REPEATABILITY),
        load_declarations(Path(snakemake.input.declarations)),
    )
    folder = Path(snakemake.params.folder)
    for name, table in tables.items():
        write_table(table, folder / f"{name}.parquet", PUBLISHED_NAVIGATION if name == "table2" else PUBLISHED_POSES)
        write_csv(table, folder / f"{name}.csv")
        with atomic_write(folder / f"{name}.md") as path:
            path.write_text(markdown(table, f"Table {name[-1]}, published and obtained"), encoding="utf-8")
    worst = max(table["difference_sigmas"].abs().max() for table in tables.values() if "difference_sigmas" in table)
    log.info("largest difference of a pose: %.2f published sigmas", worst)
