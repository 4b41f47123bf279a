"""What figures and report cost from existing results: `python benchmarks/figures.py [platform ...]`.

Least of a few repetitions, this process alone, after imports (another 2 s a job); targets of 40 s and 5 s wall time.
"""

import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import yaml

from linepose.config.project import load_project
from linepose.errors import LineposeError
from linepose.output.figures.render import render_figures
from linepose.output.report.assemble import platform_on_page
from linepose.output.report.page import render_platform_page
from linepose.output.report.provenance import settings_text, versions
from linepose.pipeline.calibration import Calibration

ROOT = Path(__file__).resolve().parents[1]
FIGURES_TARGET_S, REPORT_TARGET_S = 40.0, 5.0


def least_seconds(function: Callable[[], object], repetitions: int) -> tuple[float, float]:
    """Least wall and processor time of a call."""
    seconds = []
    for _ in range(repetitions):
        start = time.perf_counter(), time.process_time()
        function()
        seconds.append((time.perf_counter() - start[0], time.process_time() - start[1]))
    return min(wall for wall, _ in seconds), min(processor for _, processor in seconds)


def report(calibration: Calibration) -> str:
    """The whole page of a platform."""
    one = platform_on_page(calibration, calibration.platform_file.model_dump(mode="json"))
    return render_platform_page(one, settings_text({}), versions())


def main() -> None:
    """Print the table."""
    project = load_project(yaml.safe_load((ROOT / "config" / "config.yaml").read_text()) | {"offline": True}, ROOT)
    names = sys.argv[1:] or [name for name in project.study.platforms if name in project.platforms]

    def results(name: str) -> Calibration:
        folder, threshold_px = ROOT / "results" / name, project.study.outliers.threshold_px
        return Calibration.from_results(folder, project.platforms[name], threshold_px, data_folder=project.folder(name))

    print(f"{'':<34}{'wall, s':>10}{'processor, s':>14}{'target, s':>11}")
    try:
        for name in names:
            with tempfile.TemporaryDirectory() as folder:
                wall, processor = least_seconds(
                    lambda name=name, folder=folder: render_figures(results(name), Path(folder)), 2
                )
            print(f"{f'all figures of {name}':<34}{wall:>10.1f}{processor:>14.1f}{FIGURES_TARGET_S:>11.0f}")
        wall, processor = least_seconds(lambda: [report(results(name)) for name in names], 3)
        print(f"{f'reports of {len(names)} platforms':<34}{wall:>10.1f}{processor:>14.1f}{REPORT_TARGET_S:>11.0f}")
    except (KeyError, LineposeError) as error:
        sys.exit(f"benchmarks/figures.py: {error}; run `make reproduce` first")


if __name__ == "__main__":
    main()
