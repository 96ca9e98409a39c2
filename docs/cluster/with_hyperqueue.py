#!/usr/bin/env python3
"""A study or a batch on HyperQueue, one task a run:

    with_hyperqueue.py [--server DIR] [--cpus 4] [--tries 3] study STUDY.toml RESULTS
    with_hyperqueue.py batch TRIALS RESULTS [options of pantin batch]

RESULTS lies on a file system that all workers share. Without --server, which names the folder of a server that runs (`hq server start`),
a server with one worker is started on this machine for as long as the work takes. Needs `pip install hyperqueue`.
"""

import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys

from hyperqueue import Client, Job, LocalCluster
from hyperqueue.cluster import WorkerConfig
from hyperqueue.ffi.protocol import ResourceRequest


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--server", help="folder of a running server")
    parser.add_argument("--cpus", type=int, default=4, help="processors a run (4)")
    parser.add_argument("--tries", type=int, default=3, help="for a run that is killed or fails (3)")
    parser.add_argument("--worker-cpus", type=int, help="without --server: processors of this machine to use (all)")
    parser.add_argument("what", choices=["study", "batch"])
    parser.add_argument("input", type=pathlib.Path)
    parser.add_argument("results", type=pathlib.Path)
    args, more = parser.parse_known_args()
    program = os.environ.get("PANTIN") or shutil.which("pantin") or "pantin"
    command = [program, args.what, str(args.input.resolve()), "-o", str(args.results.resolve()), *more]
    plan = subprocess.run([*command, "--plan"], check=True, capture_output=True, text=True).stdout
    left = [json.loads(line)["index"] for line in plan.splitlines()]
    logs = args.results / "hyperqueue"
    logs.mkdir(parents=True, exist_ok=True)

    cluster = None
    if args.server:
        client = Client(args.server)
    else:
        cluster = LocalCluster()
        cluster.start_worker(WorkerConfig(cores=args.worker_cpus))
        client = cluster.client()
    try:
        # A run that was killed goes on where it was when it is asked for again.
        for _ in range(args.tries):
            job = Job(max_fails=None)
            for index in left:
                job.program(
                    [*command, "--threads", str(args.cpus), "--run", str(index)],
                    name=str(index),
                    stdout=str(logs / f"{index}.txt"),
                    stderr=str(logs / f"{index}.err"),
                    resources=ResourceRequest(cpus=args.cpus),
                )
            submitted = client.submit(job)
            if client.wait_for_jobs([submitted], raise_on_error=False):
                left = []
                break
            left = [left[task] for task in client.get_failed_tasks(submitted)]
            print(f"{len(left)} runs failed: {', '.join(map(str, left))}", file=sys.stderr)
    finally:
        if cluster is not None:
            cluster.stop()
    collected = subprocess.run([*command, "--collect"]).returncode
    return collected or int(bool(left))


if __name__ == "__main__":
    sys.exit(main())
