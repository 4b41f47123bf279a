"""Read all that a platform recorded before any result is touched."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform
    from linepose.pipeline.load import check_readable

    folder = Path(snakemake.params.folder)
    found = check_readable(Platform.model_validate(snakemake.params.platform), folder)
    log.info("%s of %s can be read", found, folder)
