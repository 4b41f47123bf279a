# The experiments that platforms ask for: one rule an entry of linepose.experiments.registry.
# Long ones keep finished batches in results/NAME/work/EXPERIMENT until they are done, so that a killed run goes on: they
# must outlive the job, which temp() outputs and shadow folders do not, and jobs of their own would start too slowly.


def experiment_inputs(experiment):
    """The files that an experiment's entry says it needs, by name."""
    files = {
        need: f"results/{{platform}}/{need}.parquet"
        for need in experiment.needs
        if need != "samples"
    }
    if "samples" in experiment.needs:
        files["samples"] = "results/{platform}/mcmc"
    if experiment.compares:
        for need in ("observations", "outliers"):
            files[f"other_{need}"] = result_of_compared(experiment, need)
    if experiment.log:
        files["record"] = record
    if experiment.every_noise_model:
        files["compiled"] = expand(
            "results/compiled/{noise_model}.txt", noise_model=NOISE_MODELS
        )
    elif "observations" in experiment.needs:
        files["compiled"] = compiled
    return files


def result_of_compared(experiment, result):
    """This result of the platforms that an experiment compares a platform with."""
    return lambda wildcards: [
        f"results/{other}/{result}.parquet"
        for other in experiment.compared_with(PROJECT.platforms[wildcards.platform])
    ]


def experiment_parameters(experiment):
    """All that an experiment's entry says it takes from the configuration, as a rule's parameters."""

    def study(wildcards):
        return {
            key: sampling(wildcards) if key == "own_sampling" else section(key)
            for key in experiment.study
        }

    def others(wildcards):
        names = experiment.compared_with(PROJECT.platforms[wildcards.platform])
        return {name: settings_of(name) for name in names}

    def sections(wildcards):
        platform = PROJECT.platforms[wildcards.platform]
        return {one.key: one.values(platform) for one in experiment.sections}

    return {
        "platform": settings,
        "file": platform_file,
        "sections": sections,
        "study": study,
        "others": others,
        "folder": recorded_folder,
        "module": experiment.module,
        "code": script_digest("experiment", experiment.module),
        "work": f"results/{{platform}}/work/{experiment.name}",
    }


for EXPERIMENT in EXPERIMENTS:

    rule:
        name:
            EXPERIMENT.name
        input:
            **experiment_inputs(EXPERIMENT),
        output:
            **{
                name: f"results/{{platform}}/{name}.parquet"
                for name in EXPERIMENT.outputs
            },
        log:
            f"results/logs/{{platform}}/{EXPERIMENT.name}.log",
        benchmark:
            f"results/benchmarks/{{platform}}/{EXPERIMENT.name}.tsv"
        conda:
            "../../environment.yml"
        threads: EXPERIMENT.cores or workflow.cores or 1
        resources:
            mem_mb=2000,
            runtime=600 if EXPERIMENT.in_batches else 60,
        params:
            **experiment_parameters(EXPERIMENT),
        script:
            "../../scripts/experiment.py"


rule experiments:
    input:
        [file for platform in PLATFORMS for file in experiment_results(platform)],
