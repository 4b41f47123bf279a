"""Compare overlapping scans of a platform: how far apart their maps put the same ground."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform
    from linepose.output.map.platform_map import platform_map
    from linepose.output.map.strip_fit import FIT_TABLES, strip_fit
    from linepose.output.map.words import fit_sentence
    from linepose.pipeline.calibration import HAND_MEASURED, INLIERS, Calibration
    from linepose.tables import write_table

    platform, data = Platform.model_validate(snakemake.params.platform), Path(snakemake.params.folder)
    results = Path(snakemake.output.strip_fit).parent
    before, after = (
        platform_map(Calibration.from_results(results, platform, stage=stage_, data_folder=data), platform.map, data)
        for stage_ in (HAND_MEASURED, INLIERS)
    )
    tables = strip_fit(before, after)
    for name, schema in FIT_TABLES.items():
        write_table(tables[name], snakemake.output[name], schema)
    log.info("%s", fit_sentence(tables["strip_fit"].iloc[0]))
