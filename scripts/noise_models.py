"""Estimate the pose under each noise model from several sets of observations, and what the data say of each."""

from adapter import stage

with stage(snakemake) as log:
    import numpy as np

    from linepose.config.experiments import RepeatabilitySection
    from linepose.config.platform import Platform
    from linepose.config.study import sampling_settings
    from linepose.estimation.noise_models import BALANCED, PUBLISHED, ROBUST, SHARED
    from linepose.estimation.optimise import Search
    from linepose.experiments.accepted import named_pair, read_accepted, read_others
    from linepose.experiments.noise_models import (
        ALL,
        INLIERS,
        fit_noise_models,
        identifiability_table,
        noise_model_table,
        weights_table,
    )
    from linepose.experiments.schemas import IDENTIFIABILITY, NOISE_MODELS, WEIGHTS
    from linepose.tables import write_table

    params, files = snakemake.params, snakemake.input
    platform = Platform.model_validate(params.platform)
    repeatability = params.repeatability and RepeatabilitySection.model_validate(params.repeatability)
    data = read_accepted(platform, files.observations, files.outliers)
    others = read_others(params.others, files.other_observations, files.other_outliers)
    sets = {ALL: data.all.survey, INLIERS: data.accepted.survey}
    sets |= {name: other.accepted.survey for name, other in others.items()}
    pair = named_pair(data, repeatability, params.file)
    sets |= {name: data.accepted.survey.select(list(numbers)) for name, numbers in pair.items()}
    independence = sampling_settings(params.independence_sampling)
    settings = {
        PUBLISHED.name: sampling_settings(params.sampling),
        SHARED.name: independence,
        BALANCED.name: independence,
    }
    settings[ROBUST.name] = independence.replaced(n_steps=params.robust_steps)
    search = Search.model_validate(params.search)
    fits = []
    for fit in fit_noise_models(sets, platform.intrinsics(), settings, platform.start_pose(), params.seed, search):
        fits.append(fit)
        log.info("%s, %s: %s", fit.noise_model, fit.set, " ".join(f"{number:.3f}" for number in fit.pose))
    truth = None if platform.simulation is None else np.array(platform.simulation.true_pose)
    identified = identifiability_table(fits, platform.start_pose(), platform.start_covariance())
    write_table(noise_model_table(fits, truth), snakemake.output.estimates, NOISE_MODELS)
    write_table(identified, snakemake.output.identifiability, IDENTIFIABILITY)
    write_table(weights_table(fits, data.accepted.survey.number), snakemake.output.weights, WEIGHTS)
    log.info("weakest direction: %s", identified["weakest_in_words"].iloc[0])
