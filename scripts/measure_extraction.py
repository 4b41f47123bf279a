"""Hold what extraction finds in a simulated platform's scans, with labels and without, against the truth."""

from pathlib import Path

import pandas as pd
from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform
    from linepose.inputs.labels.labels import read_labels
    from linepose.inputs.observed_points import SCAN_POINTS, select_scans
    from linepose.inputs.targets.detectors import detector_of
    from linepose.inputs.targets.measured import DETECTION, EXTRACTION_ACCURACY, DetectedBoard, measure_extraction
    from linepose.pipeline.load import hand_view
    from linepose.simulation.board import target_of
    from linepose.tables import write_table

    platform = Platform.model_validate(snakemake.params.platform)
    folder, source = Path(snakemake.input.folder), platform.source
    scans = select_scans(folder, source.scans, source.left_out)
    labels, truth = read_labels(folder / source.labels, list(scans)), pd.read_parquet(snakemake.input.truth)
    target = target_of(platform.simulation.board)
    detector = detector_of(target, source.refinement, lambda: hand_view(platform, folder))
    board = DetectedBoard(target, detector, source.refinement)
    measured = measure_extraction(scans, labels, truth, board, platform.camera.n_pixels)
    write_table(measured.accuracy, snakemake.output.accuracy, EXTRACTION_ACCURACY)
    write_table(measured.detection, snakemake.output.detection, DETECTION)
    write_table(measured.points, snakemake.output.points, SCAN_POINTS)
    counts = measured.detection[["n_found", "n_visible", "n_wrong"]].sum()
    log.info("detected %d of %d visible points, %d with a wrong id", *counts)
