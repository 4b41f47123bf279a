"""Fail where a published number is not reproduced, or does not deviate as declared."""

from adapter import stage

with stage(snakemake) as log:
    from linepose.paper.regression import REGRESSION, check_passed
    from linepose.tables import read_table

    table = read_table(snakemake.input[0], REGRESSION)
    check_passed(table)
    if snakemake.params.left_out:
        log.warning("left out, as their data are not here: %s", ", ".join(snakemake.params.left_out))
    log.info("all %d published numbers passed or deviate as declared: results/regression.csv", len(table))
