"""Draw all figures of a platform."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform
    from linepose.output.figures.entry import FIGURES
    from linepose.output.figures.render import render_figures
    from linepose.pipeline.calibration import Calibration
    from linepose.pipeline.file_list import write_file_list
    from linepose.tables import write_table

    calibration = Calibration.from_results(
        Path(snakemake.input.pose).parent,
        Platform.model_validate(snakemake.params.platform),
        snakemake.params.outliers["threshold_px"],
        data_folder=Path(snakemake.params.folder),
    )
    folder = Path(snakemake.output.figures)
    index = render_figures(calibration, folder)
    write_table(index, folder / "index.parquet", FIGURES)
    write_file_list(folder, Path(snakemake.output.files))
    log.info("%d figures", (index["left_out"] == "").sum())
    for _, row in index[index["left_out"] != ""].iterrows():
        log.info("%s left out: %s", row["figure"], row["left_out"])
