# pantin: two commands do everything on a fresh machine with Rust, gcc and make.
#   make demo    makes a synthetic four-camera sequence, tracks it and writes out/demo/report.html
#   make test    formatting, lints, all tests, every benchmark once
#   make bench   the speed tables of docs/PERFORMANCE.md
#   make portability   the GPU tests on lavapipe (three subgroup sizes), SwiftShader and Mesa 25
#   make gpu-report    packs target/gpu-report, to be run on a machine with a graphics card; FROM=its results fills docs/PERFORMANCE.md
#   make wheel   the Python package, for any Linux with glibc 2.17, into target/wheels
#   make dist    an archive with the program for such a Linux, its licences, manual and completions, into target/dist
#   make shaders compiles glsl/ into glsl/compiled, which every build takes
#   make fuzz    a minute of fuzzing for every reader of a user's file (SECONDS_EACH=60)

CARGO ?= cargo
OUT ?= out/demo
SECONDS_EACH ?= 60
SUDO := $(shell [ "$$(id -u)" = 0 ] || command -v sudo)

# The shader compiler, a C++ library that only `make shaders` and the tests use. .cargo/config.toml names this folder, whatever CARGO_TARGET_DIR is.
SHADERC := target/shaderc/libshaderc_combined.a
# Debian's packages that hold its static libraries, and the libraries: libshaderc-dev's own "combined" one lacks glslang and SPIRV-Tools.
SHADERC_PACKAGES := libshaderc-dev glslang-dev spirv-tools
SHADERC_PARTS := shaderc_combined glslang SPIRV MachineIndependent GenericCodeGen OSDependent OGLCompiler HLSL SPIRV-Tools-opt \
	SPIRV-Tools glslang-default-resource-limits

.PHONY: demo test bench portability gpu-report wheel python python-tests dist shaders fuzz build ffmpeg vulkan shaderc c++ toolchain help

help:
	@sed -n 's/^#   //p' Makefile

demo: toolchain
	$(CARGO) build --release --locked
	$(CARGO) run --release --locked --quiet -- demo -o $(OUT) --force
	@echo "open $(OUT)/report.html in a browser"

build: toolchain
	$(CARGO) build --release --locked

# Whether a Vulkan driver and the validation layer are installed, as shell commands.
HAS_DRIVER = { [ -n "$$VK_ICD_FILENAMES$$VK_DRIVER_FILES" ] || ls /usr/share/vulkan/icd.d /etc/vulkan/icd.d 2>/dev/null | grep -q json; }
HAS_LAYER = { [ -n "$$VK_LAYER_PATH" ] || ls /usr/share/vulkan/explicit_layer.d /etc/vulkan/explicit_layer.d 2>/dev/null | \
	grep -q VkLayer_khronos_validation; }
# With both, a test that finds no device fails instead of being skipped.
NEEDS_VULKAN = $$(if $(HAS_DRIVER) && $(HAS_LAYER); then echo PANTIN_NEEDS_VULKAN=1; fi)

# The tests in parts, of which two run side by side, with half of the processors each: a test that waits, for the device that another has or for
# a clock, leaves the other part at work. Those that take longest come first.
TEST_PARTS := test-program-first test-devices test-program-second test-library test-agreement test-others test-documents python-tests
.PHONY: $(TEST_PARTS)
# What the device's part has of the library's tests, and the first one of the program's; all others are in those beside them.
OF_DEVICES := evaluate::device texture::device
OF_PROGRAM_FIRST := check:: reliability:: first_try:: losses:: batch:: beam:: calibrate:: demo:: features::
OTHERS := $(filter-out program agreement,$(patsubst tests/%.rs,%,$(wildcard tests/*.rs)) $(patsubst tests/%/main.rs,%,$(wildcard tests/*/main.rs)))

# One seed for the property tests: whoever runs them twice gets one answer. A plain `cargo test` draws new cases each time.
test $(TEST_PARTS): export PROPTEST_RNG_SEED = 1
# What an incremental build keeps for the next one takes a third longer to make.
test $(TEST_PARTS): export CARGO_INCREMENTAL = 0
# A failing test says its file and line without them; line tables are for profilers.
test $(TEST_PARTS): export CARGO_PROFILE_DEV_DEBUG = 0
# Everything is built at once, and once: all that is tested has the feature rerun (185 crates more), the Python package too, so that one
# library serves them all.
TESTED := --locked --workspace --features rerun
# The lints are made on the way: clippy's driver is the compiler with more to say. By itself (`cargo clippy`) it reads the sources of all
# crates once more, three minutes of two cores.
test $(TEST_PARTS): export RUSTC_WORKSPACE_WRAPPER = clippy-driver
test $(TEST_PARTS): export CLIPPY_ARGS = -Dwarnings
test: toolchain shaderc ffmpeg vulkan
	$(CARGO) fmt --all --check
	env $(FOR_PYTHON) $(CARGO) build $(TESTED) --lib --bins --tests --benches
	$(MAKE) --no-print-directory -j2 $(TEST_PARTS)
	@[ -d ../shared/data ] || echo "SKIPPED: the tests on real recordings; ../shared/data is absent"

# A part fails with its tests, and its lines come whole between those of another.
$(filter test-%,$(TEST_PARTS)): SHELL := bash
TEST = set -o pipefail; env $(NEEDS_VULKAN) $(FOR_PYTHON) RUST_TEST_THREADS=$$((($$(nproc) + 1) / 2)) $(CARGO) test $(TESTED) --exclude pantin-python
WHOLE_LINES := 2>&1 | sed -u ''

test-devices:
	$(TEST) --lib -- $(OF_DEVICES) $(WHOLE_LINES)
test-library:
	$(TEST) --lib -- $(addprefix --skip ,$(OF_DEVICES)) $(WHOLE_LINES)
test-program-first:
	$(TEST) --test program -- $(OF_PROGRAM_FIRST) $(WHOLE_LINES)
test-program-second:
	$(TEST) --test program -- $(addprefix --skip ,$(OF_PROGRAM_FIRST)) $(WHOLE_LINES)
test-agreement:
	$(TEST) --test agreement $(WHOLE_LINES)
test-others:
	$(TEST) $(addprefix --test ,$(OTHERS)) --bench '*' $(WHOLE_LINES)
test-documents:
	$(TEST) --doc $(WHOLE_LINES)

bench: toolchain shaderc
	$(CARGO) bench --locked

portability: toolchain shaderc vulkan
	tests/portability.sh

gpu-report: toolchain shaderc
ifdef FROM
	PANTIN_GPU_REPORT=$(abspath $(FROM)) $(CARGO) test --locked --test gpu_report
else
	tests/gpu-report/pack.sh
endif

# Python with what builds and tests the package, in a virtual environment of its own.
PYTHON := target/python/bin/python
$(PYTHON): python/requirements-build.txt python/requirements-test.txt
	@command -v python3 >/dev/null && python3 -c 'import ensurepip, venv' 2>/dev/null || { \
		if command -v apt-get >/dev/null; then \
			echo "installing python3-venv (Debian package) for the Python package"; \
			$(SUDO) apt-get update -qq && $(SUDO) env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq python3-venv >/dev/null; \
		else echo "no Python with venv is installed: install Python 3.9 or newer"; exit 1; fi; }
	@echo "fetching what the Python package is built and tested with into target/python"
	rm -rf target/python && python3 -m venv target/python
	target/python/bin/pip install --quiet --disable-pip-version-check -r python/requirements-build.txt -r python/requirements-test.txt
	touch $(PYTHON)

wheel: toolchain $(PYTHON)
	PATH="$(abspath target/python/bin):$$PATH" $(PYTHON) -m maturin build --manifest-path python/Cargo.toml --locked --release --zig \
		--compatibility manylinux2014 --interpreter $(PYTHON) --out target/wheels
	@ls -l target/wheels

# An extension for any Python from 3.9 on: no interpreter is asked and none linked.
FOR_PYTHON := PYO3_BUILD_EXTENSION_MODULE=1 PYO3_NO_PYTHON=1

# Its tests, beside the program, both as the other tests are built.
python: toolchain
	env $(FOR_PYTHON) $(CARGO) build $(TESTED) --lib --bins
	$(MAKE) --no-print-directory python-tests

# On the package as a wheel lays it out.
python-tests: ffmpeg $(PYTHON)
	rm -rf target/python-package && mkdir -p target/python-package
	cp -r python/pantin target/python-package/
	cp target/debug/lib_pantin.so target/python-package/pantin/_pantin.abi3.so
	env PYTHONPATH=$(abspath target/python-package) PANTIN_PROGRAM=$(abspath target/debug/pantin) $(PYTHON) -m pytest -q python/tests

dist: toolchain $(PYTHON)
	tests/dist/pack.sh $(abspath $(PYTHON))

shaders: toolchain shaderc
	PANTIN_WRITE_SHADERS=1 $(CARGO) check --locked --features reload

fuzz: toolchain shaderc
	tests/fuzz/run.sh all $(SECONDS_EACH)

# Video files are decoded by the ffmpeg program. The demo needs none: it reads numbered pictures.
ffmpeg:
	@if command -v ffmpeg >/dev/null && command -v ffprobe >/dev/null; then :; \
	elif command -v apt-get >/dev/null; then \
		echo "installing ffmpeg (Debian package) to read videos"; \
		$(SUDO) apt-get update -qq && $(SUDO) env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends ffmpeg >/dev/null; \
	else \
		echo "ffmpeg is not installed and there is no apt-get: please install ffmpeg by hand"; exit 1; \
	fi

# The GPU tests run on Mesa's software driver, under the validation layer. Building, the demo and tracking need no Vulkan.
vulkan:
	@if $(HAS_DRIVER) && $(HAS_LAYER); then :; \
	elif command -v apt-get >/dev/null; then \
		echo "installing a software Vulkan driver and the validation layer (Debian packages) for the GPU tests"; \
		$(SUDO) apt-get update -qq && $(SUDO) env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq \
			--no-install-recommends libvulkan1 mesa-vulkan-drivers vulkan-validationlayers >/dev/null; \
	else \
		echo "SKIPPED: the GPU tests; there is no Vulkan driver or validation layer, and no apt-get to install them"; \
	fi

# The packages are unpacked here and merged, not installed: nothing outside target/ changes.
shaderc: toolchain c++
	@if [ -n "$$SHADERC_LIB_DIR" ] || [ -f $(SHADERC) ]; then :; \
	elif command -v apt-get >/dev/null && command -v dpkg-deb >/dev/null; then \
		echo "fetching the shader compiler ($(SHADERC_PACKAGES), Debian packages) into target/shaderc"; \
		set -e; mkdir -p target/shaderc; work=$$(mktemp -d); trap 'rm -rf "$$work"' EXIT; top=$$(pwd); cd "$$work"; \
		fetch() { apt-get download -qq -o APT::Sandbox::User=root $(SHADERC_PACKAGES); }; \
		fetch 2>/dev/null || { $(SUDO) apt-get update -qq && fetch; }; \
		for package in *.deb; do dpkg-deb -x $$package .; done; \
		mv $$(find usr/lib -name '*.a') .; \
		{ echo create merged.a; for part in $(SHADERC_PARTS); do if [ -f lib$$part.a ]; then echo addlib lib$$part.a; fi; done; \
			echo save; echo end; } | ar -M; \
		mv merged.a "$$top/$(SHADERC)"; \
	else \
		echo "there is no apt-get: set SHADERC_LIB_DIR to a folder that holds libshaderc_combined.a or libshaderc, or build with"; \
		echo "cargo build --features shaderc-from-source, which needs cmake, git and python3"; exit 1; fi

toolchain:
	@command -v $(CARGO) >/dev/null || { echo "cargo is not installed: get Rust from https://rustup.rs"; exit 1; }
	@command -v cc >/dev/null || { \
		if command -v apt-get >/dev/null; then \
			echo "installing gcc (Debian package) to link programs"; \
			$(SUDO) apt-get update -qq && $(SUDO) env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq gcc libc6-dev >/dev/null; \
		else echo "no C compiler (cc) is installed: install gcc"; exit 1; fi; }

# The shader compiler is C++.
c++: toolchain
	@command -v c++ >/dev/null || { \
		if command -v apt-get >/dev/null; then \
			echo "installing g++ (Debian package) to link the shader compiler"; \
			$(SUDO) apt-get update -qq && $(SUDO) env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq g++ libc6-dev >/dev/null; \
		else echo "no C++ compiler (c++) is installed: install g++"; exit 1; fi; }
