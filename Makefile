SHELL := /bin/bash
.DEFAULT_GOAL := help
.PHONY: help setup demo test bench accuracy ablation package manual window lint translations test-newer test-hdmap test-cluster models fuzz

help: ## this list
	@grep -hE '^[a-z-]+:.*## ' $(firstword $(MAKEFILE_LIST)) | sed -E 's/^([a-z-]+):.*## /make \1\t/' | expand -t 16

setup: ## install what is missing (QGIS too, on Debian) and prepare build/
	@tools/setup.sh

demo: setup ## a sample survey with known truth through the whole chain, into build/demo/
	@tools/demo.sh

test: setup ## tests of core, products and library without QGIS, then the plugin in QGIS with real qgis_process calls
	@tools/test.sh

bench: setup ## time and memory of every stage beside PCL, Open3D, GDAL and laspy's read, into docs/benchmarks.md
	@tools/bench.sh

accuracy: setup ## every method over surveys with truth (SURVEYS=folder; default: the sample scenes; ONLY=name,name), into docs/accuracy.md
	@tools/accuracy.sh $(if $(SURVEYS),--surveys "$(SURVEYS)") $(if $(ONLY),--only "$(ONLY)")

ablation: setup ## what each rule brings: switched off in turn (ARGUMENTS="--scenes NAME,NAME --rules NAME,NAME --surveys FOLDER"), into build/ablation/
	@tools/ablation.sh $(ARGUMENTS)

package: ## the zip for QGIS's plugin manager, into dist/ (for plugins.qgis.org: REPOSITORY=https://… EMAIL=…)
	@REPOSITORY="$(REPOSITORY)" EMAIL="$(EMAIL)" HOMEPAGE="$(HOMEPAGE)" TRACKER="$(TRACKER)" tools/package.sh

manual: setup ## the manual's pages from the algorithms' own texts, into docs/manual/
	@tools/make_manual.sh

window: setup ## a real QGIS window driven on a screen of its own, pictures into docs/manual/img/
	@tools/screenshots.sh

lint: setup ## style, spelling, types, names that Qt 6 knows, and the scans QGIS's plugin repository makes of an upload
	@tools/lint.sh

fuzz: setup ## every reader fed with broken files, led by coverage where atheris can be installed (SECONDS=1800 of the processor; default 60)
	@tools/fuzz.sh --seconds $(or $(SECONDS),60)

translations: setup ## new texts into resources/i18n for the translators
	@source tools/env.sh && "$$PY" tools/translations.py

models: setup ## the graphical models, after an algorithm gained or lost a parameter
	@tools/make_model.sh

test-hdmap: setup ## exported HD maps read by asam-qc, pyxodr, lanelet2, carla and ezdxf, which it installs into build/hdmap/
	@tools/test_hdmap.sh

test-cluster: setup ## phases on a real Dask cluster on this computer, from PyPI into build/cluster/
	@tools/test_cluster.sh

test-newer: ## the tests on QGIS 3.44, in a Debian forky of its own under build/ (root, debootstrap)
	@tools/test_newer.sh
