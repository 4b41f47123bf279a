"""Compile a noise model's kernel once, so that no other rule pays for it."""

from adapter import stage

with stage(snakemake) as log:
    from linepose.estimation.warm_up import warm_up
    from linepose.tables import atomic_write

    noise_model = snakemake.wildcards.noise_model
    warm_up(noise_model)
    with atomic_write(snakemake.output[0]) as path:
        path.write_text(f"{noise_model}\n", encoding="utf-8")
    log.info("compiled: %s", noise_model)
