# One command each: `make demo` and `make test` set everything up first. Needs Python 3.11 or newer, make and git.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.ogilvie-ready
UV := $(shell command -v uv 2>/dev/null)

.PHONY: setup demo test unit lint types contract bench docs validate lock clean

setup: $(STAMP)

# Pinned versions with hashes first, then the project itself, without its dependencies.
$(STAMP): constraints.txt pyproject.toml
ifneq ($(UV),)
	test -x $(BIN)/python || $(UV) venv --quiet --python $(PYTHON) $(VENV)
	$(UV) pip install --quiet --compile-bytecode --python $(BIN)/python --require-hashes -r constraints.txt
	$(UV) pip install --quiet --python $(BIN)/python --no-deps --no-build-isolation -e .
else
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes -r constraints.txt
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation -e .
endif
	$(BIN)/python -m compileall -q src
	touch $(STAMP)

demo: setup
	$(BIN)/ogilvie demo

test: setup lint types contract unit

unit: setup
	OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest -q -n 2 --dist worksteal

lint: setup
	$(BIN)/ruff check --quiet .
	$(BIN)/ruff format --quiet --check .

types: setup
	$(BIN)/mypy

contract: setup
	$(BIN)/lint-imports

bench: setup
	$(BIN)/python -m benchmarks

validate: setup
	$(BIN)/ogilvie validate

docs: setup
	$(BIN)/sphinx-build -W -q -b html docs docs/_build/html

# Tested versions: names, versions and hashes, no addresses.
lock: setup
	$(BIN)/uv pip compile --quiet --universal --python-version 3.11 --all-extras --generate-hashes --no-emit-index-url \
	  --no-annotate --no-header -o constraints.txt pyproject.toml constraints.in

clean:
	rm -rf $(VENV) .pytest_cache .mypy_cache .ruff_cache .import_linter_cache docs/_build
