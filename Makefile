# make fig_3_2 | make test | make setup | make help | make TARGET TIER=quick
PYTHON ?= python3
CORES ?= 2
TIER ?= $(tier)
READY := .venv/.ready
unexport PYTHONDONTWRITEBYTECODE  # jobs start faster where compiled code is kept
SNAKEMAKE = .venv/bin/snakemake --cores $(CORES)

.PHONY: setup test help FORCE
help: $(READY)
	@$(SNAKEMAKE) --dry-run 2>.venv/help || { cat .venv/help >&2; exit 1; }

setup: $(READY)
$(READY): environment.txt pyproject.toml
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or newer is needed")'
	$(PYTHON) -m venv .venv
	.venv/bin/python -m pip install --quiet --disable-pip-version-check -r environment.txt
	touch $@

test: $(READY)
	.venv/bin/python -m pytest --numprocesses $(CORES) --dist worksteal

Makefile environment.txt pyproject.toml: ;
%: $(READY) FORCE
	$(SNAKEMAKE) $@ $(if $(TIER),--config tier=$(TIER))
