# Two commands do everything on a fresh machine: `make demo` and `make test`. Each makes .venv from requirements.lock first.
PYTHON ?= python3
BIN := .venv/bin
READY := .venv/ready
TESTS := $(BIN)/python -m pytest -n 2 --dist loadfile --durations=40 --durations-min=5
export JAX_COMPILATION_CACHE_DIR ?= $(CURDIR)/.venv/jax-cache

.PHONY: install demo test test-slow validate bench docs lint lock

install: $(READY)

$(READY): requirements.lock pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "jaxhydro needs Python 3.11 or newer; set PYTHON=python3.12, say")'
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation -e .
	@touch $@

demo: $(READY)     ## calibrate VolturnUS-S to the nine embedded decays: coefficients, errors, figures, a page, in out/demo
	$(BIN)/jaxhydro demo --out out/demo

test: $(READY)     ## what every change is tested with, on two cores
	$(TESTS) -m "not slow and not validate"

test-slow: $(READY) ## whole jobs: diagnoses, calibrations in waves, notebooks, the documentation site
	$(TESTS) -m "slow and not validate"

validate: $(READY) ## slow: regenerates the evidence in docs/validation.md
	$(BIN)/python -m pytest -m validate -s
	$(BIN)/python -m benchmarks.validate

bench: $(READY)    ## speed as ratios in one run: benchmarks/results.md
	$(BIN)/python -m benchmarks.bench

docs: $(READY)     ## the documentation site: out/docs/index.html
	$(BIN)/sphinx-build -W --keep-going -q -b html -d out/doctrees docs out/docs

lint: $(READY)
	$(BIN)/ruff check jaxhydro calibration tests benchmarks docs/*.py
	$(BIN)/ruff format --check jaxhydro calibration tests benchmarks docs/*.py
	$(BIN)/mypy
	$(BIN)/lint-imports --no-cache

lock:              ## remake requirements.lock from pyproject.toml (needs uv)
	uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --extra dev pyproject.toml \
	  --custom-compile-command "make lock" -o requirements.lock
