"""The section on the camera's clock: the offset, what it hangs together with, and the pose with it and without."""

import numpy as np

from linepose.experiments.clock_offset import CLOCK_OFFSET
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS, TURN_WORDS
from linepose.output.report.sections import SectionOnPage, TableOnPage
from linepose.pipeline.calibration import Calibration


def clocks_section(calibration: Calibration) -> SectionOnPage | None:
    """The section; None where the experiment was not asked for."""
    if not calibration.results.has("clock_offset"):
        return None
    row = calibration.results.table("clock_offset", CLOCK_OFFSET).iloc[0]
    sigmas = [f"{1e3 * row['sampled_sigma_s']:.1f} ms from samples of the noise model"]
    if np.isfinite(row["jackknife_sigma_s"]):
        sigmas.append(f"{1e3 * row['jackknife_sigma_s']:.1f} ms from leaving out one observation at a time")
    advice = f" What to do: {row['advice']}" if row["advice"] else ""
    warning = "" if row["identifiable"] else "Warning: "
    text = f"{warning}{row['verdict']}{advice} One sigma is the larger of {' and '.join(sigmas)}."
    anchor = f"{calibration.name}-clock-offset"
    poses = [
        [
            name.rsplit("_", 1)[0].replace("theta_", "theta e_") + (" (m)" if name.endswith("_m") else " (rad)"),
            f"{row[f'{name}_without']:.4f} ± {row[f'{sigma}_without']:.4f}",
            f"{row[name]:.4f} ± {row[sigma]:.4f}",
            f"{row['correlation_' + name.rsplit('_', 1)[0]]:+.2f}",
        ]
        for name, sigma in zip(POSE_COLUMNS, SIGMA_COLUMNS, strict=True)
    ]
    turns = [[words, "", "", f"{row[f'correlation_{name}']:+.2f}"] for name, words in TURN_WORDS.items()]
    heads = ["Parameter", "Clocks taken to agree", "Offset estimated", "Correlation with the offset"]
    title = "Pose with and without the clock offset"
    sentence = f"-log L {row['neg_log_likelihood_without']:.2f} without, {row['neg_log_likelihood']:.2f} with it."
    table = TableOnPage(f"{anchor}-table", title, sentence, heads, [*poses, *turns])
    return SectionOnPage(anchor, "The camera's clock", text, [table])
