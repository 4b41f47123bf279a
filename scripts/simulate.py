"""Make what a simulated platform records, and keep the truth aside."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.geometry.camera import Camera
    from linepose.pipeline.file_list import write_file_list
    from linepose.simulation.record import write_survey
    from linepose.simulation.settings import settings_from_dict

    camera = Camera.model_validate(snakemake.params.camera)
    settings = settings_from_dict(snakemake.params.simulation)
    folder = Path(snakemake.output.folder)
    write_survey(folder, camera, settings)
    (folder / "truth.parquet").replace(snakemake.output.truth)
    write_file_list(folder, Path(snakemake.output.files))
    log.info("%d scans in %s", len(settings.passes), folder / "scans")
