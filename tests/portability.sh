#!/bin/sh
# Runs the GPU tests on every Vulkan driver that can be had without a GPU, under two validation layers, and prints a table.
#
#   Mesa's lavapipe as installed, with subgroups of 4, 8 and 16 invocations
#   SwiftShader, from Debian's chromium-common package
#   Mesa 25, from bookworm-backports (on Debian 12)
#
# Last the report of `make gpu-report` is packed and run.
#
# Each once with the installed validation layer and once with the newer one of chromium-common, which finds more hazards.
# Packages are unpacked into target/portability; the system is left as it is. Words on the command line choose other tests.
set -eu

top=$(cd "$(dirname "$0")/.." && pwd)
cd "$top"
work=$top/target/portability
mkdir -p "$work"
[ $# -gt 0 ] || set -- gpu:: vulkan search::device features::device features::stages texture::stages synth::device

say() { printf '%s\n' "$*" >&2; }

command -v apt-get >/dev/null && command -v dpkg-deb >/dev/null || {
    say "there is no apt-get: only the installed driver can be tested (cargo test)"
    exit 1
}

# unpack PACKAGE FOLDER [APT OPTIONS]: downloads a package as an ordinary user may, and unpacks it.
unpack() {
    package=$1 folder=$2
    shift 2
    rm -rf "$folder.part"
    mkdir -p "$folder.part/download"
    (cd "$folder.part/download" && apt-get -qq -o APT::Sandbox::User=root "$@" download "$package") || return 1
    for archive in "$folder.part"/download/*.deb; do dpkg-deb -x "$archive" "$folder.part"; done
    mv "$folder.part" "$folder"
}

if [ ! -d "$work/chromium" ]; then
    say "fetching SwiftShader and a newer validation layer (chromium-common, Debian package) into target/portability"
    unpack chromium-common "$work/chromium"
fi
chromium=$work/chromium/usr/lib/chromium

mkdir -p "$work/layer"
cat >"$work/layer/VkLayer_khronos_validation.json" <<JSON
{
    "file_format_version": "1.2.0",
    "layer": {
        "name": "VK_LAYER_KHRONOS_validation",
        "type": "GLOBAL",
        "library_path": "$chromium/libVkLayer_khronos_validation.so",
        "api_version": "1.4.300",
        "implementation_version": "1",
        "description": "Khronos validation layer of chromium-common",
        "instance_extensions": [
            { "name": "VK_EXT_debug_report", "spec_version": "9" },
            { "name": "VK_EXT_debug_utils", "spec_version": "1" },
            { "name": "VK_EXT_validation_features", "spec_version": "2" },
            { "name": "VK_EXT_layer_settings", "spec_version": "2" }
        ]
    }
}
JSON

mesa=$work/mesa
if [ ! -d "$mesa" ] && grep -qs '^VERSION_CODENAME=bookworm' /etc/os-release; then
    say "fetching Mesa of bookworm-backports into target/portability"
    lists=$work/apt
    mkdir -p "$lists/lists/partial" "$lists/cache/archives/partial"
    keys=/usr/share/keyrings/debian-archive-keyring.gpg
    echo "deb [signed-by=$keys] http://deb.debian.org/debian bookworm-backports main" >"$lists/sources.list"
    backports="-o Dir::Etc::SourceList=$lists/sources.list -o Dir::Etc::SourceParts=/dev/null"
    backports="$backports -o Dir::State::Lists=$lists/lists -o Dir::Cache=$lists/cache"
    # shellcheck disable=SC2086 # several options in one word
    if apt-get -qq -o APT::Sandbox::User=root $backports update && unpack mesa-vulkan-drivers "$mesa" $backports; then :; else
        say "bookworm-backports cannot be reached: Mesa 25 is left out"
    fi
fi

cargo=${CARGO:-cargo}
$cargo test --locked --lib --no-run
failed=0

# check NAME VARIABLES...: the tests on a driver, with either layer.
check() {
    name=$1
    shift
    device=$(env "$@" "$cargo" run --locked --quiet -- devices | sed -n 2p | sed 's/   */, /g')
    for layer in installed newer; do
        newer=
        [ $layer = installed ] ||
            newer="VK_LAYER_PATH=$work/layer VK_KHRONOS_VALIDATION_SYNCVAL_SHADER_ACCESSES_HEURISTIC=true"
        log=$work/$(echo "$name $layer" | tr ' ' '-').log
        # shellcheck disable=SC2086 # several variables in one word
        if env "$@" $newer PANTIN_NEEDS_VULKAN=1 "$cargo" test --locked --quiet --lib -- $tests $left_out >"$log" 2>&1; then
            verdict=passed
        else
            verdict=FAILED failed=1
            grep -E '^(test .*FAILED|---- |thread |\[|error)' "$log" | cut -c1-400 >&2 || true
        fi
        count=$(sed -n 's/^test result: [^.]*\. \([0-9]* passed; [0-9]* failed\).*/\1/p' "$log")
        printf '%-12s %-10s %-7s %-22s %s\n' "$name" "$layer" "$verdict" "$count" "$device"
    done
}

tests=$*
left_out=
printf '%-12s %-10s %-7s %-22s %s\n' driver layer verdict tests device
for width in 128 256 512; do
    check "lavapipe $width" LP_NATIVE_VECTOR_WIDTH=$width
done
# Its compiler unrolls the noise of every kind and dimension: minutes a pipeline, and memory until the machine has none left.
say "swiftshader: the noise stages (texture::stages) are left out, its compiler runs out of memory on them"
left_out="--skip texture::stages"
check swiftshader VK_ICD_FILENAMES="$chromium/vk_swiftshader_icd.json" VK_DRIVER_FILES="$chromium/vk_swiftshader_icd.json"
left_out=
if [ -d "$mesa" ]; then
    icd=$mesa/usr/share/vulkan/icd.d/lvp_icd.json
    check "mesa 25" LD_LIBRARY_PATH="$mesa/usr/lib/x86_64-linux-gnu" VK_ICD_FILENAMES="$icd" VK_DRIVER_FILES="$icd"
fi
# The folder for machines with a card, packed and run here as there: that it runs and packs no more than it may.
say "packing and running target/gpu-report on the installed driver"
if tests/gpu-report/pack.sh && sh target/gpu-report/run.sh "$work/gpu-report" 8 && [ "$(ls "$work/gpu-report" | wc -l)" -le 8 ]; then :; else
    say "the GPU report failed: see target/portability/gpu-report"
    failed=1
fi
[ $failed = 0 ] || say "the whole output of each run is in target/portability/*.log"
exit $failed
