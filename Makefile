# openacr: every target does all set-up it needs (python3 >= 3.11 and make are enough).
#
#   make demo    run the gantry example for 60 simulated seconds and draw it
#   make test    lint, type check, import contract and all tests
#   make lint    the checks alone
#   make bench   how many simulated seconds per second this machine reaches
#   make soak    the long-running tests, and all cases of those that make test draws some of
#   make lowest  all tests with the oldest versions of the packages that are allowed
#   make audit   the oldest versions that are allowed against the public list of advisories
#   make mutate  break changed lines and list what no test notices (WHAT=package or all, BASE=revision, MOST=n, EACH=n)
#   make docs    write the reference pages, the names of the map and the grammars of editors anew
#   make editor-test  the extension in Visual Studio Code in a browser (CODE_SERVER=folder, needs Node)
#   make web-lint   type-check and lint the screens' JavaScript, check its format (needs Node)
#   make web-format  format the screens' JavaScript with Prettier (needs Node)
#   make web-bundle bundle the libraries of the screens anew (needs Node and a registry)
#   make site    the documentation as web pages with a search, in build/site
#   make clean   remove everything that can be made again (also .venv)
#
# A C compiler makes the card many times faster; without one the same sources run as
# plain Python with identical results.

SHELL := /bin/sh
.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
MAKEFLAGS += --jobs=2 # the core is compiled while packages are installed
# Tests start some hundred processes; without this each would compile all sources anew where the
# user has asked Python not to keep what it compiles.
export PYTHONDONTWRITEBYTECODE :=
.PHONY: help setup demo test browser lint style types bench soak lowest audit mutate docs editor-test web-lint web-format web-bundle site clean

VENV := .venv
PY := $(VENV)/bin/python
PIP := $(PY) -m pip --disable-pip-version-check -qq --retries 2
# A module is compiled when it is imported first: most never are.
INSTALL := $(PIP) install --no-compile
# `make PYTHON=/path/to/python3.12 test` chooses another interpreter for the environment.
PYTHON ?= $(shell for p in python3 python3.14 python3.13 python3.12 python3.11; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$p && break; done)

# The stamps say what is up to date: the environment, what compiles the core, the compiled core, the
# packages of the demo and of what it points to at its end, all packages.
MADE := $(VENV)/.made
TOOLS := $(VENV)/.tools
BUILT := $(VENV)/.built
RUNS := $(VENV)/.runs
INSTALLED := $(VENV)/.installed
CORE_SOURCES := setup.py src/openacr/unity.py src/openacr/unity_c.py src/openacr/cmath.py src/openacr/csystem.pxd src/openacr/views.py \
	src/openacr/messages.py src/openacr/map/fingerprint.py $(shell find src -name '*_cy.py')
# A third of the time a test waits for other processes, and each worker imports all anew: two more than cores.
WORKERS ?= $(shell cores=$$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2); echo $$((cores + 2)))

# In front of a command that is long and silent: a line every few seconds until its shell ends.
BEAT_S := 5
BEAT = ( while sleep $(BEAT_S) >/dev/null 2>&1 && kill -0 $$$$ 2>/dev/null; do \
	echo "  $$(date +%H:%M:%S) still busy"; done ) &

help:
	@sed -n '3,18s/^# *//p' Makefile

setup: $(BUILT) $(INSTALLED)

$(MADE):
	@test -n "$(PYTHON)" || { echo "error: Python 3.11 or newer is needed (python3)"; exit 2; }
	@test -x $(PY) || { echo "creating $(VENV) with $(PYTHON)"; $(PYTHON) -m venv $(VENV); } || { \
		rm -rf $(VENV); echo "error: $(PYTHON) cannot make a virtual environment;" \
		"install its venv module (Debian and Ubuntu: apt install python3-venv)"; exit 2; }
	@touch $@

$(TOOLS): pyproject.toml $(MADE)
	@echo "installing what compiles the core"
	@$(BEAT) $(INSTALL) "setuptools>=77" "cython>=3.1" || \
		echo "setuptools and Cython were not installed; carrying on with what is there"
	@touch $@

$(BUILT): $(CORE_SOURCES) $(TOOLS)
	@echo "building the compiled core"
	@mkdir -p build
	@$(BEAT) $(PY) setup.py --quiet build_ext --inplace >build/core.log 2>&1 || true
	@PYTHONPATH=src $(PY) -c 'from openacr.compiled import is_compiled; import sys; sys.exit(not is_compiled)' \
		2>/dev/null || echo "note: no compiled core (no C compiler? see build/core.log);" \
		"running the slower pure-Python kernel"
	@touch $@

EDITABLE = OPENACR_PURE=1 $(INSTALL) --no-build-isolation --editable
$(RUNS): pyproject.toml $(TOOLS)
	@echo "installing openacr into $(VENV)"
	@$(BEAT) $(EDITABLE) ".[panel,plot]"
	@touch $@

$(INSTALLED): pyproject.toml $(TOOLS)
	@echo "installing openacr and all that develops it into $(VENV)"
	@$(BEAT) $(EDITABLE) ".[dev,bridge,dxf,lsp,panel,plot,sweep]"
	@touch $(RUNS) $@

demo: $(BUILT) $(RUNS)
	@mkdir -p out
	$(VENV)/bin/openacr run examples/gantry --for 60 --plot out/gantry.png
	@echo "the picture is in out/gantry.png"
	@echo "screens in the browser: $(VENV)/bin/openacr panel"

lint: style types

style: setup
	$(VENV)/bin/ruff check
	$(VENV)/bin/ruff format --check

TYPES := $(VENV)/bin/mypy && $(VENV)/bin/lint-imports
types: setup
	$(TYPES)

# The tests of the screens need a Chrome, Chromium or Edge; one is installed only if none is found.
browser: setup
	@$(PY) -m tests.panel.browser.chromium

# Types and imports are checked while the tests run; what that says follows their result.
PYTEST := $(PY) -m pytest -n $(WORKERS) -m "not soak"
test: style browser
	@mkdir -p build
	@($(TYPES)) >build/types.log 2>&1 & types=$$!; \
	$(PYTEST) --durations 10; tests=$$?; \
	wait $$types; types=$$?; cat build/types.log; \
	test $$types -eq 0 || echo "error: types or imports are not as they should be (above)"; \
	test $$tests -eq 0 || echo "error: tests failed (above)"; \
	exit $$((tests ? tests : types))

bench: setup
	$(PY) -m bench

soak: setup
	OPENACR_SEARCH=whole $(PY) -m pytest -n 0 -m "soak or search" --timeout 0

# Every lower bound of pyproject.toml, in an environment of its own (uv finds the versions).
LOWEST := .venv-lowest
lowest:
	@test -x $(LOWEST)/bin/python || $(PYTHON) -m venv $(LOWEST)
	@$(LOWEST)/bin/python -m pip install -qq uv
	OPENACR_PURE=1 $(LOWEST)/bin/uv pip install --python $(LOWEST)/bin/python -q \
		--resolution lowest-direct --editable ".[dev,bridge,dxf,lsp,panel,plot,sweep]"
	$(LOWEST)/bin/python setup.py --quiet build_ext --inplace
	$(LOWEST)/bin/python -m pytest -n $(WORKERS) -m "not soak" $(TESTS)

# No version with a known fault may be one that pyproject.toml allows; pip-audit asks the public list.
AUDIT := build/audit
audit:
	@test -x $(AUDIT)/bin/python || $(PYTHON) -m venv $(AUDIT)
	@$(AUDIT)/bin/python -m pip install -qq uv pip-audit
	$(AUDIT)/bin/uv pip compile -q --resolution lowest-direct --all-extras pyproject.toml -o build/lowest.txt
	$(AUDIT)/bin/pip-audit --strict --no-deps --disable-pip -r build/lowest.txt

# Of the lines changed since BASE (default: the last commit), or of WHAT="kernel/status/limits_cy.py protocol".
mutate: setup
	$(PY) -m mutation $(WHAT) $(if $(BASE),--base $(BASE)) $(if $(MOST),--most $(MOST)) $(if $(EACH),--each $(EACH)) --workers $(WORKERS)

docs: setup
	$(PY) -m openacr.map.generate
	$(PY) -m openacr.basic.reference docs/reference examples
	$(PY) -m openacr.sysvar.reference docs/sysvar-tables.md
	$(PY) -m openacr.cnc.reference docs/part-program-codes.md
	$(PY) -m openacr.mill.run.lifecycle_page docs/run-life-cycle.md
	$(PY) -m openacr.conform.pages docs/cases.md
	$(PY) -m openacr.editing.grammars editors/vscode/syntaxes

# The libraries of the panel's screens come bundled; Node is needed only to change or to check them.
WEB := web-bundle
WEB_TOOLS := $(WEB)/node_modules/.package-lock.json
NPM := npm --prefix $(WEB) --no-audit --no-fund --silent
$(WEB_TOOLS): $(WEB)/package-lock.json
	@command -v npm >/dev/null || { echo "error: npm is needed (Node 20 or newer)"; exit 2; }
	$(NPM) ci --ignore-scripts
	@touch $@

web-lint: $(WEB_TOOLS)
	$(NPM) run lint

web-format: $(WEB_TOOLS)
	$(NPM) run format

# editors/vscode/README.md says how code-server is installed.
editor-test: setup
	@test -n "$(CODE_SERVER)" || { echo "error: CODE_SERVER=FOLDER of code-server is needed"; exit 2; }
	CODE_SERVER="$(CODE_SERVER)" $(PY) -m pytest -n 0 tests/editors/in_the_editor.py

web-bundle: $(WEB_TOOLS)
	$(NPM) run bundle

# The pages of docs/ and the Python interface with a search, in build/site; a broken link ends it.
site: setup
	@echo "installing what makes the site"
	@$(BEAT) $(EDITABLE) ".[site]"
	@rm -rf build/site-pages build/site
	@cp -r docs build/site-pages && cp site/*.md site/conf.py build/site-pages/
	@$(PY) -m openacr.conform.pages build/site-pages/cases.md build/site-pages/cases
	@echo "writing the pages"
	@$(BEAT) $(PY) -m sphinx -q -W --keep-going -j auto -b html build/site-pages build/site
	@echo "the site is in build/site/index.html"

clean:
	rm -rf $(VENV) $(LOWEST) build dist out .mypy_cache .ruff_cache .pytest_cache .hypothesis \
		.import_linter_cache src/openacr.egg-info src/openacr/_compiled.*
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
