#!/usr/bin/env bash
# A study or a batch on a Slurm cluster, one task of an array a run:
#   docs/cluster/slurm.sh study STUDY.toml RESULTS      docs/cluster/slurm.sh batch TRIALS RESULTS [options of pantin batch]
# RESULTS lies on a file system that all nodes share. CPUS (4) processors a run, TRIES (3) for one that was killed; SBATCH_ options of
# yours (account, partition, time) are read from the environment by sbatch. Prints the number of the job that collects.
set -euo pipefail
what=$1 input=$(realpath "$2") results=$(realpath -m "$3")
shift 3
cpus=${CPUS:-4} tries=${TRIES:-3} program=${PANTIN:-$(command -v pantin)}
runs=$("$program" "$what" "$input" -o "$results" "$@" --plan | wc -l)
mkdir -p "$results/slurm"
quoted=$(printf '%q ' "$program" "$what" "$input" -o "$results" --threads "$cpus" "$@")

# What is killed within its task goes on at once; what is lost with its node is queued again by Slurm.
array=$(sbatch --parsable --requeue --open-mode=append --array="0-$((runs - 1))" --cpus-per-task="$cpus" --job-name="pantin-$what" \
	--output="$results/slurm/%a.txt" --wrap="for try in \$(seq $tries); do $quoted --run \$SLURM_ARRAY_TASK_ID && exit; done; exit 1")
sbatch --parsable --dependency="afterany:$array" --job-name="pantin-$what-collect" --output="$results/slurm/collect.txt" \
	--wrap="$quoted --collect"
