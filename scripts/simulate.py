"""Make what a simulated platform records, and keep the truth aside."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.geometry.camera import Camera
    from linepose.pipeline.file_list import write_file_list
    from linepose.simulation.flight_section import FlightSection
    from linepose.simulation.flown_record import write_flight
    from linepose.simulation.record import write_survey
    from linepose.simulation.settings import settings_from_dict
    from linepose.simulation.true_camera import TrueCamera

    camera = Camera.model_validate(snakemake.params.camera)
    camera = TrueCamera.model_validate(snakemake.params.true_camera or {}).instead_of(camera)
    folder = Path(snakemake.output.folder)
    if snakemake.params.flight is not None:
        flight = FlightSection.model_validate(snakemake.params.flight)
        write_flight(folder, camera, flight)
        n_scans = len(flight.strips)
    else:
        settings = settings_from_dict(snakemake.params.simulation)
        write_survey(folder, camera, settings)
        n_scans = len(settings.passes)
    (folder / "truth.parquet").replace(snakemake.output.truth)
    write_file_list(folder, Path(snakemake.output.files))
    log.info("%d scans in %s", n_scans, folder / "scans")
