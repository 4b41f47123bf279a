# linepose for clusters whose nodes take images: docs/cluster.md
FROM python:3.11-slim-bookworm

WORKDIR /linepose
COPY . .
RUN pip install --no-cache-dir --constraint requirements.lock '.[slurm]'

# Compiled kernels are kept beside the package, where the user of a container may not write.
ENV NUMBA_CACHE_DIR=/tmp/linepose-compiled
RUN useradd --create-home --uid 1000 linepose
USER 1000
WORKDIR /project
ENTRYPOINT ["snakemake", "--snakefile", "/linepose/Snakefile"]
