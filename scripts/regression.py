"""Hold the results against the published numbers."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.yaml_file import read_yaml
    from linepose.paper.declarations import load_declarations
    from linepose.paper.number_sets import NUMBER_SETS
    from linepose.paper.regression import REGRESSION, obtained_numbers, regression_table
    from linepose.tables import read_table, write_csv, write_table

    platforms = snakemake.params.platforms
    folder = Path(snakemake.output.parquet).parent
    results = {
        name: {table: read_table(folder / name / f"{table}.parquet") for table in NUMBER_SETS[numbers].results}
        for name, numbers in platforms.items()
    }
    published = read_yaml(Path(snakemake.input.published))
    declarations = load_declarations(Path(snakemake.input.declarations))
    table = regression_table(obtained_numbers(published, results, platforms), declarations)
    write_table(table, snakemake.output.parquet, REGRESSION)
    write_csv(table, snakemake.output.csv)
    deviating = int(table["expected"].notna().sum())
    log.info(
        "%d of %d published numbers passed, %d declared: known deviations and expected intervals",
        table["passed"].sum(),
        len(table),
        deviating,
    )
