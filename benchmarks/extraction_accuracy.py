"""Bias and sigma (px) of both refinements against the truth, over speeds, ranges and noise; a table on the terminal.

Full scales of 20,000 and 1,000 electrons are bright light, and light so dim that shot noise is 3 % of white.

`python benchmarks/extraction_accuracy.py`
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from linepose.config.platform import load_platform
from linepose.inputs.scans.scan_files import Scan
from linepose.inputs.targets.accuracy import compare_methods
from linepose.inputs.targets.detect import detect
from linepose.inputs.targets.refine import METHODS
from linepose.simulation.projection import exact_projections
from linepose.simulation.record import true_lines
from linepose.simulation.render import render
from linepose.simulation.sensor import expose

PASSES = (12, 11, 1)  # of the simulated Shrimp: near, middle, far
SPEEDS_M_S = (0.05, 0.2, 0.8)
FULL_SCALES_ELECTRONS = (20_000.0, 1_000.0)
LABEL_SIGMA_PX = 1.0


def main() -> None:
    """Print the table."""
    platform = load_platform(Path(__file__).parents[1] / "config" / "platforms", "shrimp-sim")
    camera, base = platform.intrinsics(), platform.simulation
    tables = []
    for number in PASSES:
        for speed in SPEEDS_M_S:
            drive = replace(base.passes[number - 1], speed_m_s=speed, duration_s=2.0 / speed)
            for electrons in FULL_SCALES_ELECTRONS:
                image = replace(base.image, full_scale_electrons=electrons, margin_share=0.2)
                settings = replace(base, passes=(drive,), faults=(), image=image)
                exposure, truth = render(camera, settings, 1), exact_projections(camera, settings)
                rng = np.random.default_rng([number, int(electrons)])
                intensity = expose(rng, image, exposure.light).mean(axis=1, dtype=np.float32)
                exact = np.stack([truth.u_px[0], true_lines(camera, settings)[0]], axis=-1)
                seen = np.isfinite(exact).all(axis=1)
                exact, rate = exact[seen], truth.v_px_s[0, seen] / image.line_rate_hz
                labels = exact + LABEL_SIGMA_PX * rng.standard_normal(exact.shape).clip(-3, 3)
                found = detect(Scan(intensity, np.arange(len(intensity)), "scan"), METHODS["centroid"])
                table = compare_methods(METHODS, intensity, labels, exact, rate)
                setting = {"range_m": -drive.east_m, "speed_m_s": speed, "electrons": electrons}
                about = {"lines_per_px": 1 / abs(rate.mean()), "n_detected": len(found.point)}
                tables.append(table.assign(**setting, **about))
    table = pd.concat(tables).set_index(["method", "range_m", "speed_m_s", "electrons"]).sort_index()
    print(table.round(3).to_string())


if __name__ == "__main__":
    main()
