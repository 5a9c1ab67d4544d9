# make fig_3_2 | make test | make docs | make setup | make help | make TARGET TIER=quick
PYTHON ?= python3
CORES ?= 2
READY := .venv/.ready
unexport PYTHONDONTWRITEBYTECODE  # jobs start faster where compiled code is kept
SNAKEMAKE = .venv/bin/snakemake --cores $(CORES)
# Words for the shell, just as they were typed.
quoted = '$(subst ','\'',$(1))'
tier_typed = $(or $(value TIER),$(value tier))

.PHONY: setup test docs help FORCE
help: $(READY)
	@$(SNAKEMAKE) --dry-run 2>.venv/help || { cat .venv/help >&2; exit 1; }

setup: $(READY)
$(READY): environment.lock.txt pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or newer is needed")'
	@echo "Installing the packages into .venv: about a minute"
	@$(PYTHON) -m venv .venv
	@.venv/bin/python -m pip install --quiet --disable-pip-version-check --require-hashes -r environment.lock.txt
	@.venv/bin/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation -e .
	@touch $@

test: $(READY)
	.venv/bin/python -m pytest --numprocesses $(CORES) --dist worksteal

docs: $(READY)
	@.venv/bin/python -m sphinx --quiet --fail-on-warning --keep-going --fresh-env docs site
	@echo "site/index.html"

Makefile environment.lock.txt pyproject.toml: ;
%: $(READY) FORCE
	@$(SNAKEMAKE) $(call quoted,$@) $(if $(tier_typed),--config $(call quoted,tier=$(tier_typed)))
