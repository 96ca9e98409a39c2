#!/usr/bin/env bash
# The recipes of docs/cluster on this machine: a study of eight runs with Slurm (Debian's slurm-wlm, one node), HyperQueue and Snakemake (PyPI),
# eight at once, two of them killed on the way. Their tables and every poses.csv equal those of one process, byte for byte.
#   tests/outside/cluster.sh [PROGRAM] [slurm|hyperqueue|snakemake ...]
set -euo pipefail
cd "$(dirname "$0")/../.."
top=$PWD
export PANTIN
PANTIN=$(realpath "${1:-target/release/pantin}")
shift || true
engines=${*:-slurm hyperqueue snakemake}
sudo=$([ "$(id -u)" = 0 ] || command -v sudo || true)
work=$(mktemp -d)
trap 'pkill -x slurmctld || true; pkill -x slurmd || true; rm -rf "$work"' EXIT
chmod 755 "$work"

cat > "$work/study.toml" <<'TOML'
name = "shared"
seeds = [1, 2, 3, 4, 5, 6, 7, 8]
particles = [60]
iterations = [8]
backends = ["cpu"]
models = ["flat"]
[[sequence]]
preset = "demo"
length = 12
[[table]]
name = "errors"
value = "error"
rows = ["sequence"]
columns = []
TOML
runs=8

echo "one process"
"$PANTIN" study "$work/study.toml" -o "$work/serial" > /dev/null 2>&1

# Kills two of the runs that a recipe has begun, once all eight are there.
kill_two() {
	local tries=0 found
	while :; do
		found=$(pgrep -f -- "$1 .*--run " | while read -r id; do [ "$(cat "/proc/$id/comm" 2>/dev/null)" = pantin ] && echo "$id"; done || true)
		most=$(wc -w <<< "$found")
		[ "$most" -ge "$runs" ] && break
		tries=$((tries + 1))
		[ $tries -lt 1500 ] || { echo "only $most of $runs ran at once"; return 1; }
		sleep 0.02
	done
	# shellcheck disable=SC2086
	set -- $found
	kill -9 "$2" "$5"
	echo "  $most ran at once; killed two"
}

compare() {
	cmp "$work/serial/table-errors.csv" "$work/$1/table-errors.csv"
	local count=0
	for poses in "$work"/serial/runs/*/poses.csv; do
		cmp "$poses" "$work/$1/runs/$(basename "$(dirname "$poses")")/poses.csv"
		count=$((count + 1))
	done
	[ $count -eq $runs ] || { echo "$count runs, expected $runs"; return 1; }
	echo "  $1: the table and $count poses.csv are those of one process"
}

slurm() {
	command -v slurmctld > /dev/null || { echo "installing slurm-wlm (Debian package)"; $sudo apt-get update -qq;
		$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends slurm-wlm munge > /dev/null; }
	mkdir -p "$work/slurm/state" "$work/slurm/spool" /run/munge && chown munge: /run/munge
	pgrep -x munged > /dev/null || $sudo runuser -u munge -- /usr/sbin/munged
	# More processors than the machine has, so that eight run at once.
	cat > "$work/slurm/slurm.conf" <<-CONF
		ClusterName=one
		SlurmctldHost=$(hostname -s)(127.0.0.1)
		SlurmUser=root
		SlurmdUser=root
		AuthType=auth/munge
		StateSaveLocation=$work/slurm/state
		SlurmdSpoolDir=$work/slurm/spool
		SlurmctldPidFile=$work/slurm/slurmctld.pid
		SlurmdPidFile=$work/slurm/slurmd.pid
		SlurmctldLogFile=$work/slurm/slurmctld.log
		SlurmdLogFile=$work/slurm/slurmd.log
		SlurmdParameters=config_overrides
		ProctrackType=proctrack/linuxproc
		TaskPlugin=task/none
		SelectType=select/cons_tres
		SelectTypeParameters=CR_CPU
		ReturnToService=2
		MaxArraySize=1001
		NodeName=$(hostname -s) NodeAddr=127.0.0.1 CPUs=8 State=UNKNOWN
		PartitionName=all Nodes=ALL Default=YES State=UP
	CONF
	export SLURM_CONF=$work/slurm/slurm.conf
	slurmctld
	slurmd
	for _ in $(seq 100); do [ "$(sinfo -h -o %T 2>/dev/null)" = idle ] && break; sleep 0.2; done
	collector=$(CPUS=1 "$top/docs/cluster/slurm.sh" study "$work/study.toml" "$work/slurm-results")
	kill_two "$work/slurm-results"
	for _ in $(seq 600); do [ -z "$(squeue -h -j "$collector" 2>/dev/null)" ] && break; sleep 0.5; done
	mv "$work/slurm-results" "$work/slurm-done"
	compare slurm-done
}

python() {
	[ -x "$work/python/bin/python" ] || python3 -m venv "$work/python"
	"$work/python/bin/pip" install --quiet --disable-pip-version-check "$1"
}

hyperqueue() {
	python hyperqueue==0.27.0
	"$work/python/bin/python" "$top/docs/cluster/with_hyperqueue.py" --cpus 1 --worker-cpus 8 study "$work/study.toml" "$work/hyperqueue" \
		> "$work/hyperqueue.log" 2>&1 &
	kill_two "$work/hyperqueue"
	wait $! || { tail -5 "$work/hyperqueue.log"; return 1; }
	compare hyperqueue
}

snakemake() {
	python snakemake==9.27.1
	(cd "$work" && "$work/python/bin/snakemake" -s "$top/docs/cluster/Snakefile" --cores 8 --quiet all \
		--config what=study input="$work/study.toml" results="$work/snakemake" cpus=1 pantin="$PANTIN" > "$work/snakemake.log" 2>&1) &
	kill_two "$work/snakemake"
	wait $! || { tail -15 "$work/snakemake.log"; return 1; }
	compare snakemake
}

for engine in $engines; do
	echo "$engine"
	$engine
done
