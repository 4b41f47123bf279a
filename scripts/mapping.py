"""Project the observed points onto the pattern's plane, before and after the calibration."""

import numpy as np
from adapter import stage

with stage(snakemake) as log:
    from linepose.config.experiments import MappingSection
    from linepose.config.platform import Platform
    from linepose.experiments.accepted import read_accepted, read_reference
    from linepose.experiments.mapping import mapping_summary, mapping_table, perturbed
    from linepose.experiments.schemas import MAPPING, MAPPING_SUMMARY
    from linepose.geometry.plane import fit_plane
    from linepose.tables import write_table

    platform = Platform.model_validate(snakemake.params.platform)
    settings = MappingSection.model_validate(snakemake.params.mapping)
    data = read_accepted(platform, snakemake.input.observations, snakemake.input.outliers)
    reference = read_reference(data.accepted, snakemake.input.optima, snakemake.input.samples)
    estimated = data.accepted.residuals(reference.parameters).point_m
    plane = fit_plane(estimated)
    poses = {
        "hand_measured": (platform.start_pose(), platform.start_covariance()),
        "calibrated": (reference.pose, reference.covariance),
        "perturbed": (perturbed(reference.pose, np.deg2rad(settings.perturbation_deg)), reference.covariance),
    }
    table = mapping_table(data.all.survey, data.all.camera, poses, plane)
    summary = mapping_summary(table, plane, estimated, data.accepted.survey.number)
    write_table(table, snakemake.output.points, MAPPING)
    write_table(summary, snakemake.output.summary, MAPPING_SUMMARY)
    for _, row in summary.iterrows():
        log.info("%s, %s observations: %.1f mm", row["pose"], row["observations"], row["spread_mm"])
