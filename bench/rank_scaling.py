#!/usr/bin/env python3
"""Are ranks as good as threads? EM on 2 ranks of 1 thread against 1 process of 2 threads.

    python3 bench/rank_scaling.py CORPUS --program build/mpi/kinetome [--turns 5] [--iterations 6]

CORPUS is indexed once up to its features, in a temporary folder. Then pose clusters of the whole
corpus as one partition are fitted again and again, the two ways taking turns, with another seed each
turn; their seconds are what the run's own summary says of that stage: moments, principal components,
start, iterations, one file. Prints medians and their ratio; exits with 1 when the files of a turn
differ. The program must be built with MPI.
"""
import argparse
import hashlib
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

MPIRUN = ["mpirun", "--bind-to", "none", "--oversubscribe", "-n"]


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("corpus")
    parser.add_argument("--program", required=True, help="kinetome, built with MPI")
    parser.add_argument("--turns", type=int, default=5)
    parser.add_argument("--iterations", type=int, default=6)
    return parser.parse_args()


def run(command):
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    return subprocess.run(command, check=True, text=True, capture_output=True, env=environment).stdout


def stage_seconds(summary, stage):
    """Third number of the stage's line: made, reused, wall seconds."""
    line = next(line for line in summary.splitlines() if line.startswith(stage))
    return float(line.split()[3])


def fit(arguments, store, seed, ranks, threads):
    """Seconds of the stage, and the digest of its file, which is removed to be made again."""
    command = [arguments.program, "reindex", arguments.corpus, "--store", str(store), "--quiet",
               "--only", "pose_clusters", "--no-publish", "--partition", "none",
               "--max-iterations", str(arguments.iterations), "--min-gain", "1e-12",
               "--seed", str(seed), "--threads", str(threads)]
    summary = run(command if ranks == 1 else MPIRUN + [str(ranks)] + command)
    made = store / "scratch" / "run" / "pose_clusters.h5"
    digest = hashlib.sha256(made.read_bytes()).hexdigest()
    made.unlink()
    for checkpoint in made.parent.glob("checkpoint-*"):
        checkpoint.unlink()
    return stage_seconds(summary, "pose_clusters"), digest


def main():
    arguments = parse_arguments()
    with tempfile.TemporaryDirectory() as folder:
        store = pathlib.Path(folder) / "store"
        run([arguments.program, "reindex", arguments.corpus, "--store", str(store), "--quiet",
             "--only", "frames,features"])
        seconds = {(1, 2): [], (2, 1): []}
        for turn in range(arguments.turns):
            digests = set()
            ways = sorted(seconds, reverse=turn % 2 == 1)
            for ranks, threads in ways:
                taken, digest = fit(arguments, store, turn + 1, ranks, threads)
                seconds[ranks, threads].append(taken)
                digests.add(digest)
            if len(digests) > 1:
                sys.exit("rank_scaling.py: ranks and threads made different files")
        medians = {way: statistics.median(taken) for way, taken in seconds.items()}
        for (ranks, threads), taken in medians.items():
            print(f"{ranks} rank(s) x {threads} thread(s): {taken:.2f} s "
                  f"(median of {arguments.turns}: {min(seconds[ranks, threads]):.2f} to "
                  f"{max(seconds[ranks, threads]):.2f})")
        print(f"2 ranks take {medians[2, 1] / medians[1, 2]:.3f} of the time of 2 threads")


if __name__ == "__main__":
    main()
