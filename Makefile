# Every target sets up what it needs in a fresh clone with Python 3.11, venv and make.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready
LOCAL_VLM := $(VENV)/.local-vlm

.PHONY: demo test check law bench docs drives quick clean help local-vlm

help:
	@echo "make demo    lint, test and compile the shipped codes, decide the paper's situations, drive its experiment"
	@echo "make test    run every test"
	@echo "make local-vlm   install torch and transformers, for the tests of the local vision client (1 GB)"
	@echo "make check   style, types, layers, and everything make law does"
	@echo "make law     lint, form, tests, boundaries, ledger and mutation score of codes/"
	@echo "make bench   measure, in ratios of one run, against the marks"
	@echo "make drives  drive 1,000 random scenes, or those of SEEDS=\"FIRST LAST\", and say what went wrong"
	@echo "make docs    write the generated pages of docs/reference"

$(READY): pyproject.toml
	$(PYTHON) -c 'import sys; sys.exit("regdb needs Python 3.11 or newer, this is %d.%d" % sys.version_info[:2] if sys.version_info < (3, 11) else 0)'
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --upgrade 'pip>=25.1'
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[all]' --group dev
	@touch $(READY)

$(LOCAL_VLM): $(READY)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --group local-vlm
	@touch $(LOCAL_VLM)

local-vlm: $(LOCAL_VLM)

demo: $(READY)
	$(BIN)/regdb demo -o out

test: $(READY)
	$(BIN)/python -m pytest

quick: $(READY)
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports

check: quick law

law: $(READY)
	$(BIN)/regdb lint --codes codes --format concise
	$(BIN)/regdb fmt --check --codes codes
	$(BIN)/regdb test --codes codes -q
	$(BIN)/regdb test --codes codes --boundaries -q
	@mkdir -p out
	$(BIN)/regdb coverage --codes codes > out/coverage.txt || { cat out/coverage.txt; exit 1; }
	$(BIN)/regdb test --codes codes --mutate --mutate-under 90 > out/mutation.txt || { cat out/mutation.txt; exit 1; }
	@tail -n 1 out/mutation.txt

bench: $(READY)
	$(BIN)/python bench/run.py

SEEDS ?= 0 1000
drives: $(READY)
	$(BIN)/python tests/random_drives.py $(SEEDS) --jobs 2 --shrink -o out/drives

docs: $(READY)
	$(BIN)/python docs/generate.py

clean:
	rm -rf $(VENV) out dist .mypy_cache .ruff_cache .pytest_cache .import_linter_cache
