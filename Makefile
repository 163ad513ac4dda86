# Every target does its own set-up: Python >= 3.11 and make are enough.
PYTHON ?= python3
TESTS ?= tests
VENV := .venv
BIN := $(VENV)/bin
# One more than processors: now and then one waits for a browser or for a process that it started.
WORKERS ?= $(shell expr $$(getconf _NPROCESSORS_ONLN) + 1)
PYTEST := $(BIN)/pytest -n $(WORKERS) --maxprocesses 5 --dist worksteal

.DEFAULT_GOAL := help
.PHONY: help demo test test-boundscheck test-nojit coverage check format docs clean distclean

help: ## Show this list
	@echo "Usage: make TARGET [PYTHON=python3.12] [TESTS=tests/networks]"
	@awk -F ':.*## ' '/^[a-z-]+:.*## / {printf "  %-18s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

# A kernel compiled before a source file changed is never used again.
demo: export NUMBA_CACHE_DIR = $(CURDIR)/.cache/numba/demo-$(shell \
	find src -name '*.py' | LC_ALL=C sort | xargs cat | cksum | cut -d' ' -f1)
demo: $(VENV)/.installed-all ## Watch a robot learn where its hand goes; writes a report page
	$(BIN)/handeye demo

test: $(VENV)/.installed-dev ## Run the tests
	$(PYTEST) $(TESTS)

# Optimising what is only checked takes longer than the tests.
test-boundscheck: $(VENV)/.installed-dev ## Run the tests with array bounds checked in compiled code
	NUMBA_BOUNDSCHECK=1 NUMBA_OPT=1 $(PYTEST) $(TESTS)

test-nojit: $(VENV)/.installed-dev ## Run the tests with compilation off
	NUMBA_DISABLE_JIT=1 $(PYTEST) $(TESTS)

coverage: $(VENV)/.installed-dev ## Run the tests with compilation off and show lines never reached
	NUMBA_DISABLE_JIT=1 $(PYTEST) --cov --cov-report term $(TESTS)

check: $(VENV)/.installed-dev ## Format, lint, types, import layers, documentation
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/pyright
	$(BIN)/lint-imports --no-logo --cache-dir .cache/import-linter
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --strict --quiet

format: $(VENV)/.installed-dev ## Format the code and mend what the linter can
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

docs: $(VENV)/.installed-dev ## Serve the documentation while it is being written
	$(BIN)/mkdocs serve

clean: ## Remove caches and build outputs
	rm -rf .cache .hypothesis .pytest_cache .ruff_cache build dist site out
	find src tests benchmarks docs -name __pycache__ -type d -prune -exec rm -rf {} +

distclean: clean ## Remove the virtual environment as well
	rm -rf $(VENV)

$(VENV)/.created:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { \
		echo "handeye needs Python 3.11 or newer and $(PYTHON) is not:" \
			"choose one with 'make PYTHON=python3.11 ...'" >&2; exit 1; }
	$(PYTHON) -m venv $(VENV)
	touch $@

$(VENV)/.installed-all: pyproject.toml $(VENV)/.created
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[all]'
	touch $@

# Brings everything that the demo needs, too.
$(VENV)/.installed-dev: pyproject.toml $(VENV)/.created
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[dev,bench]'
	touch $(VENV)/.installed-all $@
