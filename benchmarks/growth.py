"""How the workflow grows with processes, jobs and platforms: `python benchmarks/growth.py`; minutes.

Puts its table into docs/cluster.md, between the two marks there, with what to expect on 100 nodes by calculation.
`--print` only prints it.
"""

import argparse
import math
import os
import re
import shutil
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "workflow"))

import tiny_project
from process_cost import Cost, measured

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "cluster.md"
BEGIN, END = "<!-- growth -->\n", "<!-- end of growth -->\n"
JOBS = (10, 100, 1000)
PLATFORMS = (1, 10, 100)
JOB_COST = re.compile(r"took \S+ s, (\S+) s of processor time", re.ASCII)  # the end of a job's log
PROCESSES = (1, 2)
NODES, CORES_OF_A_NODE = 100, 16
CELLS, SURVEYS = 44, 200  # of the coverage study
SUBMISSION_S = 0.3  # assumed: what sbatch takes the head process for a job
TRIVIAL = """\
rule all:
    input: expand("{{number}}.done", number=range({jobs}))
rule one:
    output: "{{number}}.done"
    shell: "touch {{output}}"
"""
QUICK = {
    "like": "ladybird-sim",
    "experiments": dict.fromkeys(["basin", "repeatability", "sensitivity", "adjustment_beside"]),
}
REGIME = {"white": {"white_level": 1.0, "noise_models": ["published"]}}


def main() -> None:
    """Measure all, print the table, and put it into the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--print", action="store_true", help="Only print the table.")
    parser.add_argument("--surveys", type=int, default=40, help="Surveys of the coverage cell that is timed.")
    parser.add_argument("--study", type=int, default=10, help="Platforms of the study that is run.")
    arguments = parser.parse_args()
    rows = [f"{os.cpu_count()} cores, with a load of {os.getloadavg()[0]:.0f} at the beginning.", ""]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        overhead_s = jobs(folder, rows)
        start_s = platforms(folder, rows)
        study(folder, arguments.study, rows)
        survey_s = processes(folder, arguments.surveys, rows)
    expected(overhead_s, survey_s, start_s, rows)
    print("\n".join(rows))
    if not arguments.print:
        before, rest = PAGE.read_text(encoding="utf-8").split(BEGIN)
        PAGE.write_text(f"{before}{BEGIN}\n" + "\n".join(rows) + f"\n\n{END}{rest.split(END)[1]}", encoding="utf-8")


def jobs(folder: Path, rows: list[str]) -> float:
    """Of jobs that do nothing: what Snakemake itself takes; the overhead a job, in seconds, of the most jobs."""
    rows += [
        "| jobs that do nothing | dry run | overhead a job, locally | head process at its peak |",
        "| --- " * 4 + "|",
    ]
    overhead_s = 0.0
    for count in JOBS:
        place = folder / f"jobs-{count}"
        place.mkdir()
        (place / "Snakefile").write_text(TRIVIAL.format(jobs=count))
        dry = snakemake(place, "--cores", "2", "--dry-run", "--quiet", "all")
        run = snakemake(place, "--cores", "2", "--quiet", "all")
        overhead_s = max(run.wall_s - dry.wall_s, 0.0) / count
        rows.append(f"| {count:,} | {dry.wall_s:.1f} s | {overhead_s:.2f} s | {run.peak_mb:.0f} MB |")
    return overhead_s


def platforms(folder: Path, rows: list[str]) -> float:
    """Of linepose's own workflow: what planning takes; processor time, in seconds, of one platform's."""
    start_s = 0.0
    rows += ["", "| platforms | jobs | dry run | head process at its peak |", "| --- " * 4 + "|"]
    for count in PLATFORMS:
        place = project(folder / f"platforms-{count}", count, 1)
        log = place / "dry-run.txt"
        command = ["--snakefile", str(ROOT / "Snakefile"), "--cores", "2", "--dry-run", "--quiet", "rules"]
        cost = snakemake(place, *command, log=log)
        start_s = start_s or cost.processor_s
        total = next(line.split()[1] for line in log.read_text().splitlines() if line.startswith("total "))
        rows.append(f"| {count} | {int(total):,} | {cost.wall_s:.1f} s | {cost.peak_mb:.0f} MB |")
    return start_s


def study(folder: Path, count: int, rows: list[str]) -> None:
    """Of a study of tiny platforms that is run, from scans to pages: what a job costs beside its own work."""
    place = project(folder / "study", count, 1, tiny_project.QUICK)
    targets = [f"results/p{number}/report.html" for number in range(count)]
    command = ["--snakefile", str(ROOT / "Snakefile"), "--cores", "2", "--quiet", "all", "--"]
    cost = snakemake(place, *command, *targets, "results/report.html")
    logs = [path.read_text() for path in (place / "results" / "logs").rglob("*.log")]
    of_jobs_s = [float(found[1]) for found in map(JOB_COST.search, logs) if found]
    beside_s = (cost.processor_s - sum(of_jobs_s)) / len(of_jobs_s)
    rows += [
        "",
        "| tiny platforms, run | jobs | time | a job's own work | beside it, a job | head process at its peak |",
    ]
    rows += ["| --- " * 6 + "|"]
    work = f"{sum(of_jobs_s) / len(of_jobs_s):.2f} s | {beside_s:.2f} s of processor time"
    rows += [f"| {count} | {len(of_jobs_s):,} | {cost.wall_s:.0f} s | {work} | {cost.peak_mb:.0f} MB |"]


def processes(folder: Path, surveys: int, rows: list[str]) -> float:
    """Of a coverage cell: what more processes save; seconds of one core a survey, start-up included."""
    rows += ["", f"| processes | coverage cell of {surveys} surveys | processor time |", "| --- " * 3 + "|"]
    place = project(folder / "processes", 1, surveys)
    cell = "results/coverage/cells/p0/white/published.parquet"
    command = ["--snakefile", str(ROOT / "Snakefile"), "--quiet", "all"]
    snakemake(place, "--cores", "1", *command, "--", "results/compiled/published.txt")
    survey_s = 0.0
    for count in PROCESSES:
        cost = snakemake(place, "--cores", str(count), *command, "--forcerun", "coverage_part", "--", cell)
        survey_s = survey_s or cost.processor_s / surveys
        rows.append(f"| {count} | {cost.wall_s:.0f} s | {cost.processor_s:.0f} s |")
    return survey_s


def expected(overhead_s: float, survey_s: float, start_s: float, rows: list[str]) -> None:
    """The coverage study on one machine and on many nodes, by calculation; a job on a node starts Snakemake twice."""
    many = NODES * CORES_OF_A_NODE
    named = f"{NODES} nodes of {CORES_OF_A_NODE} cores"
    rows += [
        "",
        f"By calculation, the coverage study of {CELLS} cells of {SURVEYS} surveys: {survey_s:.2f} s of one core",
    ]
    rows += [f"a survey, start-up included; {2 * start_s:.1f} s for the two starts of Snakemake that a job on a node"]
    rows += [f"begins with; {SUBMISSION_S} s, assumed, to submit it.", ""]
    rows += ["| where | jobs | work on each core | handing out jobs | all |", "| --- " * 5 + "|"]
    for where, cores, parts, cost_s, handed_s in (
        ("2 cores, locally", 2, 4, 0.0, overhead_s),
        (f"{named}, 4 parts a cell", many, 4, 2 * start_s, SUBMISSION_S),
        (f"{named}, 20 parts a cell", many, 20, 2 * start_s, SUBMISSION_S),
    ):
        count = CELLS * parts
        work_s = math.ceil(count / cores) * (SURVEYS / parts * survey_s + cost_s)
        handing_s = count * handed_s
        minutes = [f"{seconds / 60:.1f} min" for seconds in (work_s, handing_s, work_s + handing_s)]
        rows.append(f"| {where} | {count} | {' | '.join(minutes)} |")


def project(place: Path, n_platforms: int, n_surveys: int, platform: Mapping[str, Any] = QUICK) -> Path:
    """A folder with so many simulated platforms, without long experiments, and a coverage study of one cell."""
    shutil.copytree(ROOT / "config", place / "config", ignore=shutil.ignore_patterns("paper"))
    names = [f"p{number}" for number in range(n_platforms)]
    for name in names:
        (place / "config" / "platforms" / f"{name}.yaml").write_text(yaml.safe_dump(dict(platform)))
    coverage = {"platforms": names[:1], "n_surveys": n_surveys, "batch_size": 5, "regimes": REGIME}
    (place / "config" / "config.yaml").write_text(yaml.safe_dump({"platforms": names, "coverage": coverage}))
    return place


def snakemake(place: Path, *arguments: str, log: Path | None = None) -> Cost:
    """Run Snakemake in a folder; what it cost. Ends the benchmark where it fails."""
    environment = {"OMP_NUM_THREADS": "1", "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}
    return measured([sys.executable, "-m", "snakemake", *arguments], place, log or place / "log.txt", environment)


if __name__ == "__main__":
    main()
