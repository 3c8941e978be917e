# All targets of the project; `make help` lists them. Each target first installs the packages that it needs.
SHELL := /bin/sh
.DEFAULT_GOAL := build
.NOTPARALLEL:
MAKEFLAGS += --no-print-directory

# Comparisons use the Cycles of the newest Blender, whose module needs Python 3.13; without it, that of .venv.
ifneq ($(filter bench tradeoff corpus,$(MAKECMDGOALS)),)
ifneq ($(filter found,$(shell python3.13 -c pass 2>/dev/null && echo found)),)
PYTHON ?= python3.13
VENV ?= .venv-newest
endif
endif
PYTHON ?= python3
VENV ?= .venv
WERROR ?=
JOBS ?= $(shell nproc 2>/dev/null || echo 2)
FRAME ?=
SAMPLES ?=
OUT ?=
BLEND ?=
SNAPSHOT ?=
ONLY ?=
QUICK ?=
BLENDER ?=
BEFORE ?=
README ?=
MINUTES ?= 10
DIR ?=
CLONES ?=
PX ?=
SCENES ?=
SEED ?=
DENOISED ?=

python := $(VENV)/bin/python
core := build/core
# Keep compiled modules, outside the sources, even if the environment forbids it: a Blender imports the project anew for each case.
bytecode := env -u PYTHONDONTWRITEBYTECODE PYTHONPYCACHEPREFIX=$(CURDIR)/build/bytecode
# A file's tests stay together, as they share what they have rendered; the order of files is conftest.py's.
pytest = $(bytecode) $(python) -m pytest -q blender_tests -n $(JOBS) --dist loadfile --no-loadscope-reorder
tools := blender_tests/tools/start.py
cmake := cmake -S core -G Ninja $(if $(WERROR),-DLANCER_WERROR=$(WERROR))
# clang compiles kernels with sanitizers ten times faster than g++, and has a fuzzer.
clang := -DCMAKE_C_COMPILER=clang-19 -DCMAKE_CXX_COMPILER=clang++-19
# Ninja's progress line is for terminals; a log gets warnings and errors only.
compile := -j $(JOBS) $(if $(MAKE_TERMOUT),,-- --quiet)

# $(call logged,LOG,COMMAND): runs a command with its output in a log, which is printed if the command fails.
logged = $(2) >$(1) 2>&1 || { cat $(1); exit 1; }

platforms := linux-x64 linux-arm64 windows-x64 macos-arm64 macos-x64
zig = $(realpath $(wildcard build/zig/lib/python3*/site-packages/ziglang/zig))

.PHONY: build render test test-slow test-platforms mutants bench accuracy tradeoff farm-demo scaling features pilot parity differ corpus course device-check sanitize fuzz addon addons wheel bindings format clean help
.PHONY: packages-build packages-run packages-test packages-fuzz packages-format packages-platforms packages-bench
.PHONY: ready-run ready-test python-run python-test python-dev python-bench python-charts python-farm python-scaling python-zig core-configured core-programs core-tests

build: packages-build ## build the core into addon/lib, where the add-on loads the library
	@mkdir -p build
	@test -e $(core)/build.ninja -a -z '$(WERROR)' || { $(call logged,build/configure.log,$(cmake) -B $(core)); }
	@echo "== core"
	@cmake --build $(core) --target lancer $(compile)

render: ready-run ## render the showcase, or a file: make render BLEND=file.blend | SNAPSHOT=report.zip [FRAME=1] [OUT=x.png] [SAMPLES=n]
	@$(python) scenes/render.py $(if $(BLEND),--blend "$(BLEND)") $(if $(SNAPSHOT),--snapshot "$(SNAPSHOT)") $(if $(FRAME),--frame $(FRAME)) \
	  $(if $(OUT),--output "$(OUT)") $(if $(SAMPLES),--samples $(SAMPLES))

# The tests of the core are compiled and run beside those in Python, each with JOBS processes.
test: packages-test core-configured ready-test addon ## run all tests except the slow ones
	@echo "== tests of the core, and blender_tests"
	@$(MAKE) core-tests JOBS=$(JOBS) >build/core-tests.log 2>&1 & core=$$!; \
	  $(pytest) -m "not slow"; python=$$?; \
	  wait $$core; core=$$?; cat build/core-tests.log; exit $$((python | core))

test-slow: packages-test python-test core-programs addon ## run the tests that take minutes
	@echo "== a thousand renders cancelled"
	@LANCER_CANCELS=1000 $(core)/lancer_failures --gtest_brief=1 --gtest_filter='*Cancel*'
	@echo "== blender_tests, slow"
	@$(pytest) -m slow

core-configured: packages-test
	@mkdir -p build
	@$(call logged,build/configure.log,$(cmake) -B $(core) -DLANCER_TESTS=ON)

core-programs: core-configured
	@echo "== core and its tests"
	@cmake --build $(core) $(compile)

core-tests: core-programs
	@$(call logged,build/ctest.log,ctest --test-dir $(core) -j $(JOBS) --output-on-failure)
	@grep -E '^[0-9]+% tests passed|^Total Test time' build/ctest.log

device-check: packages-fuzz ## compile the formulas and the records of kernels for a graphics processor
	@sh core/device/check.sh

sanitize: packages-fuzz ## run the C++ tests under AddressSanitizer and UndefinedBehaviorSanitizer
	@mkdir -p build
	@$(call logged,build/configure-sanitize.log,$(cmake) -B build/sanitized -DLANCER_SANITIZE=ON $(clang))
	@echo "== core under sanitizers"
	@cmake --build build/sanitized $(compile)
	@$(call logged,build/ctest-sanitize.log,ctest --test-dir build/sanitized -j $(JOBS) --output-on-failure)
	@grep -E '^[0-9]+% tests passed|^Total Test time' build/ctest-sanitize.log

# Inputs that found a fault go into core/fuzz/corpus once the fault is fixed; ctest replays them.
fuzz: packages-fuzz python-test ## fuzz the C interface and the loading of snapshots: make fuzz [MINUTES=10]
	@mkdir -p build/fuzz-found build/fuzz-corpus
	@$(call logged,build/configure-fuzz.log,$(cmake) -B build/fuzz -DLANCER_FUZZ=ON $(clang))
	@echo "== core under sanitizers, to be fuzzed"
	@cmake --build build/fuzz $(compile)
	@$(call logged,build/configure-sanitize.log,$(cmake) -B build/sanitized -DLANCER_SANITIZE=ON $(clang))
	@cmake --build build/sanitized --target lancer $(compile)
	@.ci/fuzz.sh $(MINUTES) $(python)

mutants: packages-test python-test build ## make one line of a copy wrong at a time, and run the tests that must fail: make mutants [ONLY='export*'] [QUICK=1]
	@$(python) $(tools) mutants.run --jobs $(JOBS) $(if $(ONLY),--only '$(ONLY)') $(if $(QUICK),--quick)

bench: packages-run packages-bench python-bench build ## compare the renderers: make bench [QUICK=1] [ONLY='balls*'] [README=1] [BEFORE=revision]
ifneq ($(BEFORE),)
	@rm -rf build/before && mkdir -p build/before
	@git archive $(BEFORE) | tar -x -C build/before
	@echo "== core of $(BEFORE)"
	@$(call logged,build/configure-before.log,cmake -S build/before/core -B build/before/build -G Ninja)
	@cmake --build build/before/build --target lancer $(compile)
endif
	@$(python) $(tools) bench.run $(if $(BEFORE),--before build/before) $(if $(QUICK),--quick) \
	  $(if $(ONLY),--only '$(ONLY)') $(if $(README),--readme)

farm-demo: packages-run python-farm build ## render the showcase by a scheduler and two workers on this machine: make farm-demo [SAMPLES=64]
	@$(python) scenes/farm_demo.py $(if $(SAMPLES),--samples $(SAMPLES))

scaling: packages-run python-scaling build ## simulate stills on up to a thousand machines, from costs measured here: make scaling [QUICK=1] [ONLY='A,D'] [README=1]
	@$(python) $(tools) scaling.run $(if $(QUICK),--quick) $(if $(ONLY),--only '$(ONLY)') $(if $(README),--readme)

features: packages-run python-run build ## measure the cost of each feature, used and unused: make features [QUICK=1] [ONLY=glass]
	@$(python) $(tools) features.run $(if $(QUICK),--quick) $(if $(ONLY),--only '$(ONLY)')

pilot: packages-run python-run build ## fit the pilot's cost model to measured times: make pilot [QUICK=1] [ONLY='glass*']
	@$(python) $(tools) pilot.run $(if $(QUICK),--quick) $(if $(ONLY),--only '$(ONLY)')

tradeoff: packages-run python-charts build ## measure error against time: make tradeoff [BLEND=file.blend] [SAMPLES=n] [OUT=folder] [QUICK=1] [README=1] [DENOISED=1 [ONLY='balls*']]
	@$(python) $(tools) tradeoff.run $(if $(BLEND),--blend "$(BLEND)") $(if $(SAMPLES),--samples $(SAMPLES)) \
	  $(if $(OUT),--output "$(OUT)") $(if $(QUICK),--quick) $(if $(README),--readme) \
	  $(if $(DENOISED),--denoised $(if $(OUT),,--output build/denoised)) $(if $(ONLY),--only '$(ONLY)')

accuracy: packages-run python-run build ## check the error that renders report: make accuracy [QUICK=1] [ONLY='glass*']
	@$(python) $(tools) accuracy.run $(if $(QUICK),--quick) $(if $(ONLY),--only '$(ONLY)')

course: packages-test python-test build ## measure the course's texts, chapter by chapter: make course [QUICK=1] [ONLY=shadows]
	@$(python) $(tools) course.run $(if $(QUICK),--quick) $(if $(ONLY),--only '$(ONLY)')

parity: packages-run python-run build ## compare with Cycles, scene by scene: make parity [ONLY='lights*'] [QUICK=1] [BLENDER=blender]
	@$(if $(BLENDER),"$(BLENDER)" -b --factory-startup --python-exit-code 3 -P $(tools) --,$(python) $(tools)) parity.run \
	  $(if $(ONLY),--only '$(ONLY)') $(if $(QUICK),--quick)

differ: packages-run python-run build ## find what differs from Cycles without a message: make differ [SCENES=200] [SEED=1] [FEATURE=motion] [BLENDER=blender] [QUICK=1]
	@$(python) $(tools) differ.run $(if $(SCENES),--scenes $(SCENES)) $(if $(SEED),--seed $(SEED)) \
	  $(if $(BLENDER),--blender "$(BLENDER)") $(foreach feature,$(FEATURE),--feature $(feature)) $(if $(QUICK),--quick)

corpus: packages-run $(if $(DENOISED),python-charts,python-run) build ## render public files by Lancer and by Cycles: make corpus [DIR=folder] [CLONES=folder] [ONLY='*'] [QUICK=1] [PX=320] [README=1] [DENOISED=1]
	@$(python) $(tools) corpus.run $(if $(DIR),--folder "$(DIR)") $(if $(CLONES),--clones "$(CLONES)") \
	  $(if $(ONLY),--only '$(ONLY)') $(if $(QUICK),--quick) $(if $(PX),--pixels $(PX)) $(if $(BLENDER),--blender "$(BLENDER)") \
	  $(if $(README),--readme) $(if $(DENOISED),--denoised)

addon: packages-run python-run build ## build the zips for this machine: build/lancer-VERSION-PLATFORM.zip (Blender 4.2+) and -blender3.zip (3.x)
	@$(python) .ci/package.py

wheel: packages-run python-run build ## build a wheel for Python without Blender on this machine: build/lancer-VERSION-py3-none-PLATFORM.whl
	@$(python) .ci/python_wheel.py

addons: packages-run python-run python-zig ## build zips, wheels and Blender's repository of Linux, Windows and macOS: make addons [ONLY=windows-x64]
	@for platform in $(or $(ONLY),$(platforms)); do \
	  echo "== core for $$platform"; JOBS=$(JOBS) .ci/cross.sh $$platform "$(zig)" lancer || exit 1; done
	@LANCER_ZIG="$(zig)" $(python) .ci/package.py build/platforms $(or $(ONLY),$(platforms))

test-platforms: packages-platforms python-test python-zig build ## test the other platforms' libraries as far as this machine can run them: make test-platforms [ONLY=windows-x64]
	@LANCER_ZIG="$(zig)" JOBS=$(JOBS) .ci/test_platforms.sh $(python) $(or $(ONLY),$(platforms))

bindings: ## generate the Python side of the C interface from core/include/lancer.h
	@$(PYTHON) .ci/bindings.py

format: packages-format python-dev ## format C++ and Python code
	@$(VENV)/bin/ruff check --quiet --fix . && $(VENV)/bin/ruff format --quiet .
	@find core -name '*.h' -o -name '*.cpp' | xargs $(VENV)/bin/clang-format -i

clean: ## remove all build results (not .venv)
	@rm -rf build addon/lib .pytest_cache .ruff_cache
	@find addon blender_tests scenes .ci -name __pycache__ -prune -exec rm -rf {} +

help: ## list the targets
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/  make \1~\2/p' Makefile | awk -F'~' '{ printf "%-17s %s\n", $$1, $$2 }'

packages-build packages-run packages-test packages-fuzz packages-format packages-platforms: packages-%:
	@PYTHON='$(PYTHON)' .ci/packages.sh $*

# Packages that only one peer of the benchmark needs may be missing: the benchmark reports that peer as missing.
packages-bench: packages-run
	@for set in povray llvm; do PYTHON='$(PYTHON)' .ci/packages.sh $$set || true; done

# The library compiles while the packages of Python are installed.
ready-run ready-test: ready-%: packages-%
	@$(MAKE) python-$* & python=$$!; $(MAKE) build; built=$$?; wait $$python && exit $$built

python-bench: packages-run
	@$(PYTHON) .ci/environment.py $(VENV) run bench farm --optional bench-mitsuba bench-luxcore bench-embree

python-charts: packages-run
	@$(PYTHON) .ci/environment.py $(VENV) run bench

python-run: packages-run
	@$(PYTHON) .ci/environment.py $(VENV) run

python-test: packages-test
	@$(PYTHON) .ci/environment.py $(VENV) run test pictures farm

python-farm: packages-run
	@$(PYTHON) .ci/environment.py $(VENV) run pictures farm

python-scaling: packages-run
	@$(PYTHON) .ci/environment.py $(VENV) run bench farm

python-zig: packages-run
	@$(PYTHON) .ci/environment.py build/zig zig

python-dev: packages-format
	@$(PYTHON) .ci/environment.py $(VENV) dev
