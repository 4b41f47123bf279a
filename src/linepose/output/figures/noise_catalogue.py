"""The figures of the noise models side by side, for the catalogue."""

from typing import Final

from linepose.experiments.consistency import CONSISTENCY, CONSISTENCY_SUMMARY
from linepose.experiments.noise_models import IDENTIFIABILITY, NOISE_MODELS, WEIGHTS
from linepose.output.figures import consistency, identifiability, noise_models, weights
from linepose.output.figures.entry import CatalogueEntry, without

NOISE_FIGURES: Final = (
    CatalogueEntry(
        "noise_models",
        "Noise models side by side",
        "",
        "each pose parameter from every set of observations under each noise model, with bars of two sigmas",
        lambda r: noise_models.noise_models(
            r.results.table("noise_models", NOISE_MODELS), r.pose_of("hand_measured"), r.true_pose
        ),
        lambda r: noise_models.noise_models_caption(r.results.table("noise_models", NOISE_MODELS)),
        without("noise_models"),
    ),
    CatalogueEntry(
        "consistency",
        "Agreement of disjoint observations",
        "",
        "cumulative distribution of the distance in sigmas between poses from disjoint observations, by noise model",
        lambda r: consistency.consistency(r.results.table("consistency", CONSISTENCY)),
        lambda r: consistency.consistency_caption(r.results.table("consistency_summary", CONSISTENCY_SUMMARY)),
        without("noise_models"),
    ),
    CatalogueEntry(
        "weights",
        "Weights of the robust noise model",
        "",
        "bars of each view's weight above a matrix of each point's, observations across",
        lambda r: weights.weights(r.results.table("weights", WEIGHTS)),
        lambda r: weights.weights_caption(r.results.table("weights", WEIGHTS)),
        without("noise_models"),
    ),
    CatalogueEntry(
        "identifiability",
        "What the data say of each parameter",
        "",
        "bars of posterior over prior sigma of each parameter, and intervals of the inferred levels on their priors",
        lambda r: identifiability.identifiability(
            r.results.table("identifiability", IDENTIFIABILITY), r.results.table("noise_models", NOISE_MODELS)
        ),
        lambda r: identifiability.identifiability_caption(
            r.results.table("identifiability", IDENTIFIABILITY), r.results.table("noise_models", NOISE_MODELS)
        ),
        without("noise_models"),
    ),
)
