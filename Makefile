# pantin: two commands do everything on a fresh machine with Rust, gcc and make.
#   make demo    makes a synthetic four-camera sequence, tracks it and writes out/demo/report.html
#   make test    formatting, lints, all tests
#   make bench   the speed tables of docs/PERFORMANCE.md
#   make fuzz    a minute of fuzzing for every reader of a user's file (SECONDS_EACH=60)

CARGO ?= cargo
OUT ?= out/demo
SECONDS_EACH ?= 60
SUDO := $(shell [ "$$(id -u)" = 0 ] || command -v sudo)

.PHONY: demo test bench fuzz build ffmpeg toolchain help

help:
	@sed -n 's/^#   //p' Makefile

demo: toolchain
	$(CARGO) build --release --locked
	$(CARGO) run --release --locked --quiet -- demo -o $(OUT) --force
	@echo "open $(OUT)/report.html in a browser"

build: toolchain
	$(CARGO) build --release --locked

test: toolchain ffmpeg
	$(CARGO) fmt --check
	$(CARGO) clippy --locked --all-targets -- -D warnings
	$(CARGO) test --locked
	@echo "one round of every benchmark, so that none rots"
	$(CARGO) test --locked --bench evaluate --bench features --bench search
	@[ -d ../shared/data ] || echo "SKIPPED: the tests on real recordings; ../shared/data is absent"

bench: toolchain
	$(CARGO) bench --locked

fuzz: toolchain
	@command -v c++ >/dev/null || { echo "installing g++ (Debian package) to build the fuzzer"; \
		$(SUDO) apt-get update -qq && $(SUDO) env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq g++ >/dev/null; }
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

toolchain:
	@command -v $(CARGO) >/dev/null || { echo "cargo is not installed: get Rust from https://rustup.rs"; exit 1; }
	@command -v cc >/dev/null || { \
		if command -v apt-get >/dev/null; then \
			echo "installing gcc (Debian package) to link programs"; \
			$(SUDO) apt-get update -qq && $(SUDO) env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq gcc libc6-dev >/dev/null; \
		else echo "no C compiler (cc) is installed: install gcc"; exit 1; fi; }
