"""Note the residuals and the estimated points, of all observations and of the accepted ones."""

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform
    from linepose.estimation.outliers import OUTLIERS, stage_observations
    from linepose.pipeline.platform_estimator import platform_likelihood
    from linepose.pipeline.residual_tables import ESTIMATED_POINTS, RESIDUALS, residual_tables
    from linepose.pipeline.stages import OPTIMA
    from linepose.survey.observations import OBSERVATIONS, survey_from_table
    from linepose.tables import read_table, write_table

    platform = Platform.model_validate(snakemake.params.platform)
    survey = survey_from_table(read_table(snakemake.input.observations, OBSERVATIONS))
    likelihood = platform_likelihood(platform, survey)
    stages = stage_observations(read_table(snakemake.input.outliers, OUTLIERS))
    kept = {name: stages[name] for name in ("all", "inliers")}
    optima = read_table(snakemake.input.optima, OPTIMA).set_index("stage")[list(likelihood.parameter_names)]
    residuals, points = residual_tables(likelihood, kept, {name: optima.loc[name].to_numpy() for name in kept})
    write_table(residuals, snakemake.output.residuals, RESIDUALS)
    write_table(points, snakemake.output.points, ESTIMATED_POINTS)
    inliers = residuals[residuals["stage"] == "inliers"]
    log.info(
        "mean error of the inliers %.2f px, mean sigma %.2f px", inliers["error_px"].mean(), inliers["sigma_px"].mean()
    )
