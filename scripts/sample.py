"""Sample the posterior of the pose at each stage of the outlier removal."""

import sys
from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform
    from linepose.estimation.outliers import OUTLIERS, stage_observations
    from linepose.estimation.sampling import SamplingSettings, sample, stage_seed
    from linepose.pipeline.file_list import write_file_list
    from linepose.pipeline.platform_estimator import platform_likelihood
    from linepose.pipeline.stages import OPTIMA, SAMPLES, sample_table
    from linepose.survey.observations import OBSERVATIONS, survey_from_table
    from linepose.tables import read_table, with_parameters, write_table

    platform = Platform.model_validate(snakemake.params.platform)
    settings = SamplingSettings.model_validate(snakemake.params.sampling)
    survey = survey_from_table(read_table(snakemake.input.observations, OBSERVATIONS))
    likelihood = platform_likelihood(platform, survey)
    stages = stage_observations(read_table(snakemake.input.outliers, OUTLIERS))
    names = likelihood.parameter_names
    optima = read_table(snakemake.input.optima, OPTIMA).set_index("stage")[list(names)]
    schema = with_parameters(SAMPLES, names[6:])
    for name, numbers in stages.items():
        seed = stage_seed(snakemake.params.seed, len(numbers))
        chain = sample(likelihood.select(numbers), optima.loc[name], seed, settings, sys.stderr.isatty())
        write_table(sample_table(chain, names), Path(snakemake.output.samples) / f"{name}.parquet", schema)
        log.info("%s: %d samples, acceptance %.2f", name, chain.log_likelihood.size, chain.acceptance_fraction.mean())
    write_file_list(Path(snakemake.output.samples), Path(snakemake.output.files))
