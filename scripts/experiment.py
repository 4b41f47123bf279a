"""Run one experiment of a platform: the adapter of every entry of linepose.experiments.registry."""

from importlib import import_module
from pathlib import Path

from adapter import stage

with stage(snakemake):
    from linepose.config.platform import Platform
    from linepose.experiments.inputs import Inputs
    from linepose.pipeline.batches import inputs_digest, remove_finished
    from linepose.tables import write_table

    params = snakemake.params
    experiment = import_module(params.module).EXPERIMENT
    work = Path(params.work) / inputs_digest(dict(params.items()), snakemake.input)
    inputs = Inputs(
        name=snakemake.wildcards.platform,
        platform=Platform.model_validate(params.platform),
        file=params.file,
        files=dict(snakemake.input.items()),
        sections=params.sections,
        study=params.study,
        others={name: Platform.model_validate(values) for name, values in params.others.items()},
        folder=Path(params.folder),
        work=work,
        n_processes=snakemake.threads,
    )
    for name, table in experiment.run(inputs).items():
        write_table(table, snakemake.output[name], experiment.schema(name, table))
    if experiment.in_batches:
        remove_finished(work)
