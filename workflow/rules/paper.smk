# The published numbers beside those obtained. Included only where config/paper exists.
from linepose.paper.declarations import load_declarations
from linepose.paper.number_sets import NUMBER_SETS

try:
    DECLARED = load_declarations(Path("config/paper/regression.yaml")).platforms
except LineposeError as error:
    raise WorkflowError(str(error)) from None

# The set of numbers that each platform of this run is held against.
REGRESSED = {name: DECLARED[name] for name in PLATFORMS if name in DECLARED}
FIELD = [name for name, numbers in REGRESSED.items() if numbers == "ladybird"]
if len(FIELD) > 1:
    raise WorkflowError(
        f"config/paper/regression.yaml: platforms: found {' and '.join(FIELD)}, expected one platform that is held "
        "against ladybird; remove the others"
    )

REPRODUCED = set(DECLARED) <= set(STUDY.platforms)  # a run of some platforms does not
LEFT_OUT = [
    name for name in DECLARED if name not in PLATFORMS
]  # for want of their data
if REPRODUCED:
    PAPER_RESULTS += ["results/logs/regression.passed", "results/paper.html"]
if REPRODUCED or Path("results/paper.html").is_file():
    FURTHER_PAGES["Published and obtained numbers"] = "paper.html"


rule regression:
    input:
        published="config/paper/published.yaml",
        declarations="config/paper/regression.yaml",
        results=[
            f"results/{platform}/{name}.parquet"
            for platform, numbers in REGRESSED.items()
            for name in NUMBER_SETS[numbers].results
        ],
    output:
        parquet="results/regression.parquet",
        csv=report(
            "results/regression.csv",
            caption="../report/regression.rst",
            category="Report",
            labels={"result": "published and obtained numbers"},
        ),
    log:
        "results/logs/regression.log",
    conda:
        "../../environment.yml"
    resources:
        **LIGHT,
    params:
        platforms=REGRESSED,
        code=script_digest("regression"),
    script:
        "../../scripts/regression.py"


rule check_regression:
    input:
        "results/regression.parquet",
    output:
        touch("results/logs/regression.passed"),
    log:
        "results/logs/check_regression.log",
    conda:
        "../../environment.yml"
    resources:
        **LIGHT,
    params:
        left_out=LEFT_OUT,
        code=script_digest("check_regression"),
    script:
        "../../scripts/check_regression.py"


rule published_tables:
    input:
        published="config/paper/published.yaml",
        declarations="config/paper/regression.yaml",
        sigma=expand("results/{platform}/navigation_sigma.parquet", platform=FIELD),
        pose=expand("results/{platform}/pose.parquet", platform=FIELD),
        subsets=expand("results/{platform}/subsets.parquet", platform=FIELD),
        repeatability=expand("results/{platform}/repeatability.parquet", platform=FIELD),
    output:
        expand(
            "results/tables/table{number}.{kind}",
            number=[2, 3, 4, 5],
            kind=["parquet", "md"],
        ),
        *(
            report(
                f"results/tables/table{number}.csv",
                caption="../report/table.rst",
                category="Report",
                labels={"result": f"Table {number}, published and obtained"},
            )
            for number in [2, 3, 4, 5]
        ),
    log:
        "results/logs/published_tables.log",
    conda:
        "../../environment.yml"
    resources:
        **LIGHT,
    params:
        platform=FIELD,
        folder=lambda wildcards, output: str(Path(output[0]).parent),
        code=script_digest("published_tables"),
    script:
        "../../scripts/published_tables.py"


rule paper_page:
    input:
        regression="results/regression.parquet",
        tables=(
            expand("results/tables/table{number}.parquet", number=[2, 3, 4, 5])
            if FIELD
            else []
        ),
    output:
        report(
            "results/paper.html",
            caption="../report/regression.rst",
            category="Report",
            labels={"result": "published and obtained numbers, the page"},
        ),
    log:
        "results/logs/paper_page.log",
    conda:
        "../../environment.yml"
    resources:
        **LIGHT,
    params:
        left_out=LEFT_OUT,
        code=script_digest("paper_page"),
    script:
        "../../scripts/paper_page.py"
