# linepose for clusters whose nodes take images: docs/cluster.md
FROM python:3.11-slim-bookworm

# hadolint ignore=DL3008
RUN apt-get update && apt-get install --yes --no-install-recommends libexpat1 && rm -rf /var/lib/apt/lists/*

WORKDIR /linepose
COPY . .
RUN pip install --no-cache-dir --constraint requirements.lock '.[slurm]'

# Compiled kernels are kept beside the package, where the user of a container may not write.
ENV NUMBA_CACHE_DIR=/tmp/linepose-compiled
RUN useradd --create-home --uid 1000 linepose && install --directory --owner linepose /project
USER 1000
WORKDIR /project
ENTRYPOINT ["snakemake", "--snakefile", "/linepose/Snakefile"]
