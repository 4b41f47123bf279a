"""Adjust a platform's observations: pose, posterior, and what the errors were."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.adjustment.settings import AdjustmentSection
    from linepose.config.platform import Platform
    from linepose.estimation.adjustment_estimator import adjustment_estimator
    from linepose.pipeline.adjusted_schemas import ADJUSTED, STAGES
    from linepose.pipeline.adjusted_tables import adjusted_tables
    from linepose.pipeline.file_list import write_file_list
    from linepose.pipeline.known_points import known_of_survey
    from linepose.pipeline.platform_estimator import platform_conditions
    from linepose.pipeline.stages import SAMPLES
    from linepose.survey.observations import OBSERVATIONS, survey_from_table
    from linepose.survey.point_knowledge import KNOWN_POINTS, knowledge_from_table
    from linepose.tables import read_table, write_table

    platform = Platform.model_validate(snakemake.params.platform)
    settings = AdjustmentSection.model_validate(snakemake.params.adjustment)
    survey = survey_from_table(read_table(snakemake.input.observations, OBSERVATIONS))
    known = knowledge_from_table(read_table(snakemake.input.known, KNOWN_POINTS)) if snakemake.input.known else {}
    conditions = platform_conditions(platform, adjustment=settings, known_points=known_of_survey(known, survey))
    estimator = adjustment_estimator(survey, conditions)
    tables = adjusted_tables(estimator, snakemake.params.seed)
    for name, schema in (STAGES | ADJUSTED).items():
        write_table(tables[name], snakemake.output[name], schema)
    folder = Path(snakemake.output.samples)
    write_table(tables["mcmc/inliers"], folder / "inliers.parquet", SAMPLES)
    write_file_list(folder, Path(snakemake.output.files))
    for warning in filter(None, tables["diagnostics"]["warning"].unique()):
        log.warning("%s", warning)
    for _, view in tables["adjusted_views"].query("fault != ''").iterrows():
        log.info("observation %d: weight %.2g, %s", view["observation"], view["weight"], view["fault"])
