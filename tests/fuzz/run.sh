#!/usr/bin/env bash
# Fuzzes one parser, or all of them: run.sh [TARGET|all] [SECONDS]. Needs Rust (stable) and a C++ compiler, nothing else.
set -euo pipefail
cd "$(dirname "$0")"
target=${1:-all}
seconds=${2:-60}

# cargo-fuzz wants nightly for its sanitizers. Coverage alone, which guides libFuzzer, is a pass that stable knows too, and
# the parsers are safe Rust, where an address sanitizer would find nothing.
export RUSTFLAGS="--cfg fuzzing -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
-Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
-Cllvm-args=-sanitizer-coverage-trace-compares"
# With a target named, build scripts are built without those flags.
host=$(rustc -vV | sed -n 's/^host: //p')
build=${CARGO_TARGET_DIR:-$PWD/target}

if [ "$target" = all ]; then targets=$(ls seeds); else targets=$target; fi
cargo build --quiet --release --target "$host" --bins
for name in $targets; do
    mkdir -p "corpus/$name" "artifacts/$name"
    echo "fuzzing $name for $seconds s"
    # One input may take a second and half a gigabyte at most.
    "$build/$host/release/$name" "corpus/$name" "seeds/$name" -artifact_prefix="artifacts/$name/" \
        -max_total_time="$seconds" -max_len=16384 -timeout=1 -rss_limit_mb=512 -print_final_stats=1 2>&1 \
        | grep -E "panicked|^SUMMARY|ERROR|exec_per_sec|number_of_executed|#[0-9]+.DONE|expect" || true
    if [ -n "$(ls "artifacts/$name")" ]; then
        echo "$name: a failing input is in $PWD/artifacts/$name" >&2
        exit 1
    fi
done
