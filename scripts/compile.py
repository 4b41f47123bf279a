"""Compile the kernels once, so that no other rule pays for it."""

from adapter import stage

with stage(snakemake) as log:
    from linepose.likelihood.warm_up import warm_up
    from linepose.storage import whole_file

    compiled = warm_up()
    with whole_file(snakemake.output[0]) as path:
        path.write_text("\n".join(compiled) + "\n", encoding="utf-8")
    log.info("compiled: %s", ", ".join(compiled))
