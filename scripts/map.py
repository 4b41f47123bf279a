"""Put a platform's scans on the map, or a part of them; scans that are finished already are passed over."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform
    from linepose.output.map.platform_map import files_of, platform_map, write_maps
    from linepose.output.map.tables import MAP_TABLES, map_tables
    from linepose.output.map.words import scan_sentence
    from linepose.pipeline.batches import share_of
    from linepose.pipeline.calibration import Calibration
    from linepose.pipeline.file_list import write_list
    from linepose.tables import write_table

    platform, data = Platform.model_validate(snakemake.params.platform), Path(snakemake.params.folder)
    results, part = Path(snakemake.input.pose).parent, snakemake.wildcards.get("scatteritem")
    calibration = Calibration.from_results(results, platform, data_folder=data)
    maps, made = platform_map(calibration, platform.map, data), []
    if part:
        maps = maps.part(share_of(len(maps.paths), part))
    for one in write_maps(maps, results / "map", snakemake.threads):
        made.append(one)
        log.info("%d of %d: %s", len(made), len(maps.paths), scan_sentence(one))
    if part:
        Path(snakemake.output[0]).touch()
    else:
        tables = map_tables(made)
        write_table(tables["map_budget"], snakemake.output.budget, MAP_TABLES["map_budget"])
        write_table(tables["map_scans"], snakemake.output.scans, MAP_TABLES["map_scans"])
        write_list([name for one in made for name in files_of(one)], Path(snakemake.output.files))
