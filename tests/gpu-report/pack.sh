#!/bin/sh
# Packs target/gpu-report: what a Linux machine with a Vulkan driver and nothing else needs to say whether pantin is right and how
# fast it is there. At most 40 MB: the program and the stages' tests, stripped and compressed, a short sequence, and run.sh.
set -eu

top=$(cd "$(dirname "$0")/../.." && pwd)
cd "$top"
cargo=${CARGO:-cargo}
folder=$top/target/gpu-report
frames=10
most_kb=40000

say() { printf '%s\n' "$*" >&2; }

command -v strip >/dev/null || { say "strip is not installed: install binutils"; exit 1; }
$cargo build --release --locked
# As `make test` builds them: they wait for the device, not for themselves.
built=$($cargo test --locked --lib --no-run 2>&1) || { say "$built"; exit 1; }
tests=$(printf '%s\n' "$built" | sed -n 's/.*Executable.*(\(.*\))/\1/p')
release=${CARGO_TARGET_DIR:-target}/release
[ -x "$tests" ] || { say "cargo does not say where it put the tests: $built"; exit 1; }

rm -rf "$folder"
mkdir -p "$folder"
"$release/pantin" synth --preset demo --frames $frames -o "$folder/sequence" >&2
for pair in "$release/pantin pantin" "$tests stages"; do
    strip -o "$folder/${pair#* }" "${pair% *}"
    gzip -9n "$folder/${pair#* }"
done
cp tests/gpu-report/run.sh "$folder/run.sh"
"$release/pantin" --version >"$folder/version"
# A commit by its number, and whether what was packed is more than that.
git describe --always --dirty --exclude='*' >>"$folder/version" 2>/dev/null || true

kb=$(du -sk "$folder" | cut -f1)
[ "$kb" -le $most_kb ] || { say "target/gpu-report has $kb kB, more than $most_kb"; exit 1; }
say "packed target/gpu-report, $kb kB: copy it to the machine with the card and run sh run.sh there"
