#!/usr/bin/env bash
# Packs target/dist/pantin-VERSION-MACHINE-linux.tar.gz: the program for any Linux with glibc 2.17 or newer, its licences, manual, completions.
set -euo pipefail
cd "$(dirname "$0")/../.."
cargo=${CARGO:-cargo}
python=$1
machine=$(uname -m)
target=$machine-unknown-linux-gnu
version=$($cargo metadata --locked --no-deps --format-version 1 | "$python" -c 'import json, sys
print(next(p["version"] for p in json.load(sys.stdin)["packages"] if p["name"] == "pantin"))')
name=pantin-$version-$machine-linux

# Zig's linker knows the symbols of every glibc, so that what is linked here runs on old systems.
PATH=$(dirname "$python"):$PATH $cargo zigbuild --release --locked --target "$target.2.17"
program=target/$target/release/pantin

newest=$(objdump -T "$program" | grep -o 'GLIBC_[0-9.]*' | sort -uV | tail -1)
[ "$(printf '%s\n' "$newest" GLIBC_2.17 | sort -V | tail -1)" = GLIBC_2.17 ] || { echo "the program asks for $newest, expected 2.17 or older"; exit 1; }
needed=$(objdump -p "$program" | sed -n 's/ *NEEDED *//p' | grep -v -E '^(lib(c|m|dl|rt|pthread|gcc_s)\.so|ld-linux)' || true)
[ -z "$needed" ] || { echo "the program needs $needed, expected the C library alone"; exit 1; }

folder=target/dist/$name
rm -rf "$folder"
mkdir -p "$folder/completions" target/dist
install -m 755 "$program" "$folder/pantin"
strip "$folder/pantin"
# It writes no recordings (`make test` has the build that does), and says so before anything is written.
unwritten=target/dist/unwritten
said=$("$folder/pantin" demo --rerun -o $unwritten 2>&1) && { echo "demo --rerun succeeds, expected a program without recordings"; exit 1; }
case $said in *"cargo build --release --features rerun"*) ;; *) echo "demo --rerun said: $said"; exit 1 ;; esac
[ ! -e $unwritten ] || { echo "demo --rerun wrote $unwritten"; exit 1; }
cp README.md LICENSE-MIT LICENSE-APACHE "$folder/"
$cargo metadata --locked --format-version 1 --filter-platform "$target" | "$python" tests/dist/licences.py > "$folder/LICENSES-OF-CRATES.txt"
"$folder/pantin" man -o "$folder/man"
for shell in bash zsh fish; do "$folder/pantin" completions $shell > "$folder/completions/pantin.$shell"; done
tar -C target/dist --sort=name --owner=0 --group=0 --numeric-owner --mtime=@"${SOURCE_DATE_EPOCH:-0}" -czf "target/dist/$name.tar.gz" "$name"
echo "packed target/dist/$name.tar.gz, $(du -h "target/dist/$name.tar.gz" | cut -f1), asks for $newest"
