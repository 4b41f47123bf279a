"""Estimate the camera's clock offset against the navigation's, together with the pose."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.experiments import ClockOffsetSection
    from linepose.config.platform import Platform
    from linepose.config.study import sampling_settings
    from linepose.estimation.noise_models import likelihood_factory
    from linepose.estimation.optimise import Search
    from linepose.estimation.sampling import stage_seed
    from linepose.experiments.accepted import read_accepted, read_reference
    from linepose.experiments.clock_offset import PoseWithoutOffset, estimate_clock_offset
    from linepose.experiments.schemas import CLOCK_OFFSET
    from linepose.likelihood.clock_offset import with_clock_offset
    from linepose.pipeline.load import read_log
    from linepose.pipeline.result_schemas import SAMPLES, with_parameters
    from linepose.tables import write_table

    platform = Platform.model_validate(snakemake.params.platform)
    maximum_s = ClockOffsetSection.model_validate(snakemake.params.clock_offset).maximum_s
    search = Search.model_validate(snakemake.params.search)
    settings = sampling_settings(snakemake.params.sampling)
    accepted = read_accepted(platform, snakemake.input.observations, snakemake.input.outliers).accepted
    reference = read_reference(accepted, snakemake.input.optima, snakemake.input.samples)
    without = PoseWithoutOffset(reference.pose, reference.covariance, -accepted.log_likelihood(reference.parameters))
    raw_log = read_log(platform, Path(snakemake.params.folder))
    model = likelihood_factory(
        platform.noise_model, accepted.survey, platform.intrinsics(), platform.start_pose(), platform.pose_prior()
    )
    likelihood = with_clock_offset(accepted.survey, raw_log, maximum_s, model)
    seed = stage_seed(snakemake.params.seed, accepted.survey.n_observations, 1)
    table, samples = estimate_clock_offset(likelihood, without, platform.start_pose(), seed, search, settings)
    write_table(table, snakemake.output.table, CLOCK_OFFSET)
    write_table(samples, snakemake.output.samples, with_parameters(SAMPLES, likelihood.parameter_names[6:]))
    log.info("%s", table["verdict"].iloc[0])
