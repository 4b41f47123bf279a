"""The adjustment at fixed levels by other programs: SciPy, Ceres and GTSAM, to the same optimum."""

import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from unit.adjustment import timed_survey
from unit.adjustment.plain_problem import PlainProblem

from linepose.adjustment.estimate import unit_weights
from linepose.adjustment.hand_measured import hand_measured
from linepose.adjustment.levels import Levels
from linepose.adjustment.measurements import measurements_from_survey
from linepose.adjustment.settings import default_hand_covariance
from linepose.adjustment.solve import solve
from linepose.adjustment.start import start_points
from linepose.adjustment.state import Knowledge, state_at
from linepose.arrays import Floats

LEVELS = Levels(0.4, 0.1, 0.4, 0.5, 0.5, 30.0, 1.0)
HAND_ERROR = np.array([0.03, -0.02, 0.04, 0.01, -0.02, 0.015])


def prior_art(n_views: int = 16, n_points: int = 15) -> None:
    """Time of each program, and how far its pose is from the adjustment's."""
    camera, pose = timed_survey.CAMERA, timed_survey.POSE + HAND_ERROR
    survey = timed_survey.make_survey(n_views, n_points, seed=1)
    m = measurements_from_survey(survey, camera, line_period_s=timed_survey.LINE_S)
    start = state_at(pose, camera, start_points(m, camera, pose), m)
    knowledge = Knowledge(camera, hand_measured(pose, default_hand_covariance()))
    problem = PlainProblem(m, knowledge, LEVELS, start)

    def adjustment() -> tuple[Floats, float]:
        done = solve(m, knowledge, start, LEVELS, unit_weights(m), tolerance=1e-10)
        return done.state.pose, done.done.chi_squared

    adjustment()
    expected, _ = _timed("adjustment", adjustment)
    programs: dict[str, Callable[[PlainProblem], tuple[Floats, float]]] = {
        "Ceres": by_ceres,
        "GTSAM": by_gtsam,
        "SciPy": by_scipy,
    }
    for name, program in programs.items():
        try:
            found, _ = _timed(name, lambda program=program: program(problem))
        except ImportError as error:
            print(f"{name}: {error.name} is not installed; pip install -e '.[prior-art]'")
            continue
        print(f"    pose differs by {np.abs(found - expected).max():.1e}", flush=True)


def _timed(name: str, program: Callable[[], tuple[Floats, float]]) -> tuple[Floats, float]:
    start = time.thread_time()
    pose, chi_squared = program()
    print(f"{name:12s} {time.thread_time() - start:8.3f} s of one core, chi squared {chi_squared:.8f}", flush=True)
    return pose, chi_squared


def by_scipy(problem: PlainProblem) -> tuple[Floats, float]:
    """Pose and least chi squared by a trust region on the sparse Jacobian."""
    first = np.concatenate([part.ravel() for part in problem.first()])
    found = least_squares(
        lambda x: problem.residuals(x)[0],
        first,
        lambda x: problem.residuals(x)[1],
        x_scale="jac",
        tr_solver="lsmr",
        tr_options={"atol": 1e-13, "btol": 1e-13, "maxiter": 20_000, "regularize": False},
        xtol=1e-12,
        ftol=1e-13,
        gtol=1e-10,
    )
    return problem.pose(found.x[:8]), 2 * found.cost


def by_ceres(problem: PlainProblem) -> tuple[Floats, float]:
    """Pose and least chi squared by Levenberg-Marquardt with a sparse Cholesky factor, factors in Python."""
    import pyceres

    class Factor(pyceres.CostFunction):
        def __init__(self, n: int, sizes: list[int], evaluate: Callable[..., tuple[Floats, list[Floats]]]) -> None:
            pyceres.CostFunction.__init__(self)
            self.set_num_residuals(n)
            self.set_parameter_block_sizes(sizes)
            self.evaluate = evaluate

        def Evaluate(self, parameters, residuals, jacobians):  # noqa: ANN001, ANN202, N802
            values, derivatives = self.evaluate(*(np.asarray(one) for one in parameters))
            residuals[:] = values
            if jacobians is not None:
                for target, derivative in zip(jacobians, derivatives, strict=True):
                    if target is not None:
                        target[:] = derivative.ravel()
            return True

    kinds = problem.first()
    unknowns = [[row.copy() for row in kind] for kind in kinds]
    program = pyceres.Problem()
    kept = []
    for keys, evaluate, n in factors(problem):
        blocks = [unknowns[kind][index] for kind, index in keys]
        kept.append(Factor(n, [len(block) for block in blocks], evaluate))
        program.add_residual_block(kept[-1], None, blocks)
    options = pyceres.SolverOptions()
    options.linear_solver_type = pyceres.LinearSolverType.SPARSE_NORMAL_CHOLESKY
    options.max_num_iterations = 100
    options.num_threads = 1
    options.function_tolerance, options.gradient_tolerance, options.parameter_tolerance = 1e-14, 1e-10, 1e-12
    summary = pyceres.SolverSummary()
    pyceres.solve(options, program, summary)
    return problem.pose(unknowns[0][0]), 2 * summary.final_cost


def by_gtsam(problem: PlainProblem) -> tuple[Floats, float]:
    """Pose and least chi squared by Levenberg-Marquardt on a factor graph, factors in Python."""
    import gtsam

    values, graph = gtsam.Values(), gtsam.NonlinearFactorGraph()
    letters = "cpzqo"
    for letter, kind in zip(letters, problem.first(), strict=True):
        for index, row in enumerate(kind):
            values.insert(gtsam.symbol(letter, index), row)
    for keys, evaluate, n in factors(problem):
        symbols = [gtsam.symbol(letters[kind], int(index)) for kind, index in keys]

        def error(factor, values, jacobians, evaluate=evaluate, symbols=symbols):  # noqa: ANN001, ANN202, ARG001
            residual, derivatives = evaluate(*(values.atVector(one) for one in symbols))
            if jacobians is not None:
                for k, derivative in enumerate(derivatives):
                    jacobians[k] = np.asfortranarray(derivative)
            return residual

        graph.add(gtsam.CustomFactor(gtsam.noiseModel.Unit.Create(n), symbols, error))
    parameters = gtsam.LevenbergMarquardtParams()
    parameters.setRelativeErrorTol(1e-14)
    parameters.setAbsoluteErrorTol(1e-12)
    optimizer = gtsam.LevenbergMarquardtOptimizer(graph, values, parameters)
    found = optimizer.optimize()
    return problem.pose(found.atVector(gtsam.symbol("c", 0))), 2 * graph.error(found)


def factors(
    problem: PlainProblem,
) -> list[tuple[list[tuple[int, int]], Callable[..., tuple[Floats, list[Floats]]], int]]:
    """Each factor: its unknowns as (kind, index), residual and derivatives by those, number of residuals."""
    m = problem.measurements
    out = [([(0, 0)], lambda camera: (lambda r, j: (r, [j]))(*problem.prior(camera)), 8)]
    for line, (point, view) in enumerate(zip(m.point, m.view, strict=True)):
        keys = list(zip(range(5), (0, point, line, view, line), strict=True))
        out.append((keys, lambda *x, line=line: problem.measurement(line, *x), 2))
        share, new = problem.decay(line)
        if line:
            parts = [np.eye(6) / new, -share / new * np.eye(6)]
            ou = lambda z, before, s=share, n=new, j=parts: ((z - s * before) / n, j)  # noqa: E731
            out.append(([(2, line), (2, line - 1)], ou, 6))
        else:
            out.append(([(2, 0)], lambda z: (z, [np.eye(6)]), 6))
        out.append(([(4, line)], lambda own: (own, [np.eye(7)]), 7))
    out += [([(3, view)], lambda q: (q, [np.eye(6)]), 6) for view in range(m.n_views)]
    return out
