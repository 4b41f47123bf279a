# The experiments that platforms ask for: one rule an entry of linepose.experiments.registry.
# Long ones keep finished batches in results/NAME/work/EXPERIMENT until they are done, so that a killed run goes on: they
# must outlive the job, which temp() outputs and shadow folders do not, and jobs of their own would start too slowly.


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
        wildcard_constraints:
            platform=names_of(
                REMOVING_PLATFORMS if EXPERIMENT.removal else PROJECT.platforms
            ),
        conda:
            "../../environment.yml"
        threads: EXPERIMENT.cores or workflow.cores or 1
        resources:
            **(BATCHES if EXPERIMENT.in_batches else LIGHT),
        params:
            **experiment_parameters(EXPERIMENT),
        script:
            "../../scripts/experiment.py"


rule experiments:
    input:
        [file for platform in PLATFORMS for file in experiment_results(platform)],
