"""Find the most likely pose at each stage of the outlier removal."""

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform
    from linepose.estimation.optimise import Search
    from linepose.estimation.outliers import OUTLIERS, stage_observations
    from linepose.pipeline.platform_estimator import platform_likelihood
    from linepose.pipeline.stages import OPTIMA, laplace_sigma_columns, optimise_stages
    from linepose.survey.observations import OBSERVATIONS, survey_from_table
    from linepose.tables import read_table, with_parameters, write_table

    platform = Platform.model_validate(snakemake.params.platform)
    search = Search.model_validate(snakemake.params.search)
    survey = survey_from_table(read_table(snakemake.input.observations, OBSERVATIONS))
    likelihood = platform_likelihood(platform, survey)
    stages = stage_observations(read_table(snakemake.input.outliers, OUTLIERS))
    names = likelihood.parameter_names[6:]
    schema = with_parameters(OPTIMA, [*names, *laplace_sigma_columns(names)])
    optima = optimise_stages(likelihood, stages, platform.start_pose(), search)
    write_table(optima, snakemake.output[0], schema)
    for _, optimum in optima.iterrows():
        log.info("%s: -log L %.6f", optimum["stage"], optimum["neg_log_likelihood"])
