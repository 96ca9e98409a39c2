#!/bin/sh
# Says whether pantin is right on this machine's Vulkan device, and how fast: every stage against the processor first, then the
# benchmarks, then a track with a trace, then workgroup sizes and a profile. Needs Linux on x86-64 with glibc 2.35 or later, a Vulkan driver and its loader.
#
#   sh run.sh [RESULTS [TIMES]]      PANTIN_DEVICE chooses among several devices
#
# Every line has its own time limit and all together end within eight minutes, whatever hangs; TIMES multiplies the limits, for
# software devices. RESULTS (./results) gets eight files. A line out of time or left out is no failure, a wrong result is.
set -u

here=$(cd "$(dirname "$0")" && pwd)
results=${1:-$here/results}
times=${2:-1}
seconds=$((460 * times)) # for everything
mkdir -p "$results" || exit 1
results=$(cd "$results" && pwd)
rm -f "$results"/lines.tsv
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
for program in pantin stages; do
    gzip -dc "$here/$program.gz" >"$work/$program" || exit 1
    chmod +x "$work/$program"
done
# A pipeline compiled in one line is found by the next, and nothing is left in the user's folders.
export XDG_CACHE_HOME="$work/cache"
export PANTIN_NEEDS_VULKAN=1 PANTIN_TEST_VALIDATION=off PROPTEST_RNG_SEED=1
started=$(date +%s)
failed=0

# line NAME SECONDS FILE COMMAND...: one line of the report. What it prints goes to the end of FILE, its verdict to lines.tsv, and what it says
# beside that to messages.txt, under its name.
line() {
    name=$1 limit=$(($2 * times)) file=$3
    shift 3
    begin=$(date +%s)
    left=$((seconds - begin + started))
    [ "$limit" -le $left ] || limit=$left
    if [ "$limit" -lt 2 ]; then
        printf '%s\tleft out\t0\n' "$name" | tee -a "$results/lines.tsv"
        return 1
    fi
    printf '\n== %s\n' "$name" >>"$results/messages.txt"
    timeout -k 3 "$limit" "$@" >>"$file" 2>>"$results/messages.txt"
    code=$?
    case $code in
        0) verdict=passed ;;
        124 | 137) verdict='out of time' ;;
        *) verdict=FAILED failed=1 ;;
    esac
    [ $code = 0 ] || echo "== $name: $verdict, of $limit s" >>"$results/messages.txt"
    printf '%s\t%s\t%s\n' "$name" "$verdict" $(($(date +%s) - begin)) | tee -a "$results/lines.tsv"
    [ $code = 0 ]
}

# Begins with the version.
cat "$here/version" >"$results/messages.txt"
: >"$results/devices.json"
: >"$results/bench.json"
: >"$results/sweep.json"
: >"$results/profile.json"
: >"$results/track.txt"
rm -f "$results"/version.txt
line devices 30 "$results/devices.json" "$work/pantin" devices --json

# Agreement. Left out is what needs the sources or the validation layer.
agreement=$results/messages.txt
for stage in gpu:: evaluate::device::tests evaluate::device::raster_tests evaluate::device::any_device_tests \
    evaluate::device::graphics search::device features::device texture::device synth::device; do
    limit=60
    # A material is a large stage, and some drivers take seconds to compile one.
    [ $stage != texture::device ] || limit=90
    line "agreement of $stage" $limit "$agreement" "$work/stages" "$stage" --skip shaders:: --skip without_correction \
        --skip the_validation_log --skip a_variant_that_writes
done

line 'bench quick' 80 "$results/bench.json" "$work/pantin" bench --json

# The same poses by every backend, and their time; fewer candidates where a software device draws them.
small=
[ "$times" = 1 ] || small='--particles 60 --iterations 5 --passes forward'
for backend in cpu compute graphics; do
    trace=
    [ $backend = compute ] && trace=--trace
    track_began=$(date +%s%N)
    # shellcheck disable=SC2086 # options or none
    if line "track $backend" 25 "$results/messages.txt" "$work/pantin" track "$here/sequence" -o "$work/$backend" \
        --backend $backend --model flat --overlay-every 0 --seed 1 $small $trace; then
        taken=$((($(date +%s%N) - track_began) / 1000000))
        frames=$(($(wc -l <"$work/$backend/poses.csv") - 1))
        printf '%s\t%s\t%s\n' $backend "$frames" $taken >>"$results/track.txt"
        [ $backend = cpu ] || [ ! -f "$work/cpu/poses.csv" ] || \
            line "track $backend as cpu" 5 "$results/messages.txt" cmp "$work/cpu/poses.csv" "$work/$backend/poses.csv"
    fi
done

line 'bench sweep' 40 "$results/sweep.json" "$work/pantin" bench --sweep --json
# Last, since counting on a software device takes minutes.
line 'bench profile' 60 "$results/profile.json" "$work/pantin" bench --profile --json
[ ! -f "$work/compute/trace.json" ] || cp "$work/compute/trace.json" "$results/trace.json"
echo "all results are in $results"
exit $failed
