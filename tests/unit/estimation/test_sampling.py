import emcee
import numpy as np
import pytest

from linepose.errors import InputError
from linepose.estimation.sampling import SamplingSettings, sample, stage_seed

SHORT = SamplingSettings(n_walkers=12, n_burn_in=3, n_steps=5)


@pytest.mark.statistical
def test_samples_have_the_known_covariance_and_mean(gaussian, pose_covariance):
    mean = gaussian.measured.mean(axis=0)
    settings = SamplingSettings(n_walkers=100, n_burn_in=300, n_steps=2000, start_sigma_m=0.05)
    chain = sample(gaussian, mean, 1, settings)
    # samples so far apart count as one; the worst parameter's time stands for all
    time = emcee.autocorr.integrated_time(chain.parameters, tol=0).max()
    n_effective = chain.log_likelihood.size / time
    assert n_effective > 1500

    whitening = np.linalg.inv(np.linalg.cholesky(pose_covariance))
    whitened = (chain.flat() - mean) @ whitening.T
    # of unit normals: the mean's sigma is 1 / sqrt(n), a variance's sqrt(2 / n), a covariance's 1 / sqrt(n);
    # four sigmas for 27 numbers leave one chance in 600
    assert np.abs(whitened.mean(axis=0)).max() < 4 / np.sqrt(n_effective)
    monte_carlo = np.sqrt((1 + np.eye(6)) / n_effective)
    covariance = whitening @ chain.covariance() @ whitening.T
    assert np.all(np.abs(covariance - np.eye(6)) < 4 * monte_carlo)

    np.testing.assert_allclose(chain.sigma(), np.sqrt(np.diag(chain.covariance())), rtol=1e-12)
    # -2 log L above its minimum has six degrees of freedom: mean 6, variance 12
    excess = 2 * (gaussian.log_likelihood(mean) - chain.log_likelihood)
    assert abs(excess.mean() - 6) < 4 * np.sqrt(12 / n_effective)


def test_chain_has_the_kept_steps_only_with_their_likelihoods(gaussian, true_pose):
    chain = sample(gaussian, true_pose, 1, SHORT)
    assert chain.parameters.shape == (5, 12, 6)
    assert chain.log_likelihood.shape == (5, 12)
    assert chain.acceptance_fraction.shape == (12,)
    assert chain.flat().shape == (60, 6)
    np.testing.assert_array_equal(chain.flat()[12], chain.parameters[1, 0])
    np.testing.assert_array_equal(chain.log_likelihood.ravel(), gaussian.log_likelihoods(chain.flat()))


def test_burn_in_is_the_start_of_the_same_chain(gaussian, true_pose):
    whole = sample(gaussian, true_pose, 1, SamplingSettings(n_walkers=12, n_burn_in=0, n_steps=8))
    np.testing.assert_array_equal(sample(gaussian, true_pose, 1, SHORT).parameters, whole.parameters[3:])


def test_acceptance_counts_the_kept_steps(gaussian, true_pose):
    chain = sample(gaussian, true_pose, 1, SamplingSettings(n_walkers=12, n_burn_in=0, n_steps=40))
    moved = np.any(np.diff(chain.parameters, axis=0) != 0, axis=2).sum(axis=0)
    accepted = np.round(chain.acceptance_fraction * 40)
    assert np.all((accepted - moved == 0) | (accepted - moved == 1))  # the first step's move is not seen in the chain


def test_same_seed_same_samples_whatever_was_drawn_before(gaussian, true_pose):
    first = sample(gaussian, true_pose, 5, SHORT)
    np.random.seed(99)  # noqa: NPY002
    second = sample(gaussian, true_pose, 5, SHORT)
    assert first.parameters.tobytes() == second.parameters.tobytes()
    assert first.log_likelihood.tobytes() == second.log_likelihood.tobytes()


def test_another_seed_gives_other_samples(gaussian, true_pose):
    assert np.all(sample(gaussian, true_pose, 5, SHORT).parameters != sample(gaussian, true_pose, 6, SHORT).parameters)


@pytest.mark.statistical
def test_walkers_start_around_the_optimum(function_likelihood, true_pose):
    batches = []
    likelihood = function_likelihood(lambda p: batches.append(p.copy()) or np.zeros(len(p)))
    n = 2000
    sample(
        likelihood,
        true_pose,
        2,
        SamplingSettings(n_walkers=n, n_burn_in=0, n_steps=4, start_sigma_m=0.2, start_sigma_rad=0.03),
    )
    offset = (batches[0] - true_pose) / np.repeat([0.2, 0.03], 3)
    assert offset.shape == (n, 6)
    assert np.abs(offset.mean(axis=0)).max() < 4 / np.sqrt(n)
    assert np.abs(np.cov(offset.T) - np.eye(6)).max() < 4 * np.sqrt(2 / n)


@pytest.mark.statistical
def test_stretch_is_that_of_the_settings(function_likelihood, true_pose):
    batches = []
    likelihood = function_likelihood(lambda p: batches.append(p.copy()) or np.zeros(len(p)))
    sample(likelihood, true_pose, 2, SamplingSettings(n_walkers=200, n_burn_in=0, n_steps=4, stretch_scale=4.0))
    start, proposals = batches[0], batches[1]
    # proposal = other + z (walker - other): z is the ratio of the distances to `other` on a common line
    largest = 0.0
    for proposal in proposals:
        arms = start - proposal
        along = arms / np.linalg.norm(arms, axis=1, keepdims=True)
        cosine = np.abs(along @ along.T) - 2 * np.eye(len(start))
        i, j = np.unravel_index(np.argmax(cosine), cosine.shape)
        near, far = sorted(np.linalg.norm(arms[[i, j]], axis=1))
        between = np.linalg.norm(start[i] - start[j])
        largest = max(largest, far / between, 1 - near / between)
    # z is drawn from 1/4 to 4 with a density like 1 / sqrt(z): all of 100 below 2.5 with probability 0.72^100
    assert 2.5 < largest <= 4.0 * (1 + 1e-9)


def test_undefined_proposals_are_never_accepted(function_likelihood):
    likelihood = function_likelihood(lambda p: np.where(p[:, 0] < 0, np.inf, np.sum((p / 0.1) ** 2, axis=1)))
    chain = sample(likelihood, np.full(6, 0.5), 3, SamplingSettings(n_walkers=20, n_burn_in=50, n_steps=50))
    assert chain.parameters[..., 0].min() >= 0
    assert np.all(np.isfinite(chain.log_likelihood))


def test_refuses_fewer_walkers_than_two_a_parameter(gaussian, true_pose):
    with pytest.raises(InputError) as error:
        sample(gaussian, true_pose, 1, SamplingSettings(n_walkers=11))
    assert str(error.value) == ("sampling.n_walkers: found 11 walkers, expected at least 12, two a parameter; raise it")


def test_seeds_of_stages_differ_and_stay():
    seeds = [stage_seed(seed, n) for seed in (2017, 2018) for n in range(10, 26)]
    assert len(set(seeds)) == len(seeds)
    assert stage_seed(2017, 1, 2) != stage_seed(2017, 2, 1)
    assert stage_seed(2017, 16) == np.random.SeedSequence([2017, 16]).generate_state(1)[0]
    np.random.RandomState(stage_seed(2017, 25))  # it fits what the sampler takes
