"""Estimate the pose under other choices of camera, residual and data."""

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform
    from linepose.estimation.noise_models import PUBLISHED
    from linepose.estimation.optimise import Search
    from linepose.experiments.accepted import read_accepted
    from linepose.experiments.schemas import SENSITIVITY
    from linepose.experiments.sensitivity import camera_changes, sensitivity
    from linepose.likelihood.pixels import PixelLikelihood
    from linepose.pipeline.platform_likelihood import platform_likelihood
    from linepose.tables import write_table

    platform = Platform.model_validate(snakemake.params.platform)
    search = Search.model_validate(snakemake.params.search)
    nominal = read_accepted(platform, snakemake.input.observations, snakemake.input.outliers).accepted
    changes = {}
    if platform.noise_model == PUBLISHED.name:  # the other models' residuals are in pixels
        changes["residual in pixels"] = PixelLikelihood(nominal)
    for name, camera in camera_changes(platform.intrinsics()).items():
        changes[name] = platform_likelihood(platform, nominal.survey, camera)
    files = zip(snakemake.input.other_observations, snakemake.input.other_outliers, strict=True)
    for (name, other), (observations, outliers) in zip(snakemake.params.others.items(), files, strict=True):
        alike = Platform.model_validate(other | {"noise_model": platform.noise_model})
        changes[name] = read_accepted(alike, observations, outliers).accepted
    table = sensitivity(nominal, changes, platform.start_pose(), search)
    write_table(table, snakemake.output[0], SENSITIVITY)
    for _, row in table.iterrows():
        log.info("%s: %.2f sigmas", row["change"], row["mahalanobis"])
