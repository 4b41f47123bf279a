# Two commands do all: `make reproduce` and `make test`. Python 3.11 or newer and make are all they need.

PYTHON ?= python3
CORES ?= 2
BIN := .venv/bin
STAMP := .venv/installed

SHELL := bash

.PHONY: help environment reproduce test slurm-test check types style dist docs bench readme-bench reference images lock clean

help: ## What can be made
	@awk -F ':.*## ' '/^[a-z-]+:.*## /{printf "make %-13s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

$(STAMP): pyproject.toml requirements.lock
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --requirement requirements.lock
	$(BIN)/python -m pip install --quiet --no-deps --no-build-isolation --editable .
	@touch $@

environment: $(STAMP) ## The environment in .venv, and nothing else

reproduce: $(STAMP) ## Run every experiment; results go to results/
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/snakemake --cores $(CORES)

test: $(STAMP) ## Run the tests
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/pytest --numprocesses $(CORES) --dist loadfile --no-loadscope-reorder

slurm-test: $(STAMP) ## The tiny project on a SLURM of this machine alone; installs it: as root on Debian 12
	PYTHONPATH=tests/workflow $(BIN)/python tests/slurm

check: style types ## Style, the workflow's own lint, and types

types: $(STAMP) ## Types alone
	$(BIN)/mypy

style: $(STAMP) ## Style and the workflow's own lint alone
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/snakefmt --check Snakefile workflow
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/snakemake --lint
	$(BIN)/hadolint Dockerfile

dist: $(STAMP) ## Build the source distribution, and from it the wheel, in dist/
	rm -f dist/linepose-*
	$(BIN)/python -c "from setuptools import build_meta; build_meta.build_sdist('dist')"
	$(BIN)/python -m pip wheel --quiet --no-deps --no-build-isolation --wheel-dir dist dist/linepose-*.tar.gz

docs: $(STAMP) ## Build the documentation site in build/docs; a warning is an error
	$(BIN)/sphinx-build --fail-on-warning --keep-going --quiet docs build/docs

bench: $(STAMP) ## Measure speed on this machine
	@for name in machine likelihood pipeline experiments workflow scans maps adjustment; do $(BIN)/python benchmarks/$$name.py || exit 1; echo; done

readme-bench: $(STAMP) ## Measure speed and put the figures into docs/benchmarks.md and README.md; on a machine that does nothing else
	@mkdir -p build
	$(MAKE) --silent bench > build/bench.txt
	$(BIN)/python benchmarks/into_readme.py < build/bench.txt

reference: $(STAMP) ## Make docs/configuration.md from the code
	$(BIN)/python -m linepose.output.reference

images: $(STAMP) ## Make the pictures of README and docs, from results/
	$(BIN)/python -m linepose.output.report.pictures
	$(BIN)/python -m linepose.output.figures.conventions

lock: ## Take the newest versions that fit pyproject.toml into requirements.lock
	rm -rf .venv-lock
	$(PYTHON) -m venv .venv-lock
	.venv-lock/bin/python -m pip install --quiet setuptools '.[development]'
	.venv-lock/bin/python -m pip freeze --all --exclude pip --exclude linepose > requirements.lock
	rm -rf .venv-lock

clean: ## Remove results, keep the environment
	rm -rf results .snakemake
