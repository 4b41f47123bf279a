rule simulate:
    output:
        folder=directory("results/{platform}/simulated"),
        truth="results/{platform}/truth.parquet",
    log:
        "results/logs/{platform}/simulate.log",
    wildcard_constraints:
        platform="|".join(PROJECT.simulated) or "[^\\s\\S]",
    conda:
        "../../environment.yml"
    threads: 2
    params:
        camera=lambda wildcards: settings(wildcards)["camera"],
        simulation=lambda wildcards: settings(wildcards)["simulation"],
        code=script_digest("simulate"),
    script:
        "../../scripts/simulate.py"
