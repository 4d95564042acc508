#!/usr/bin/env python3
"""EM iterations of Kinetome against scikit-learn's, from one start, on equal threads.

    python3 bench/mixture_peer.py --program build/release/bench/mixture_bench \
        [--frames 106000 --dimension 15 --clusters 1000 --threads 1] [--rows file.npy]

Needs numpy and scikit-learn (Debian: python3-numpy python3-sklearn) and, to be fair to them,
libopenblas0-pthread: without it numpy multiplies by the slow reference BLAS. Both fit spherical Gaussians
from the same means, variances and weights. An iteration of scikit-learn is a quarter of the
difference between fits of 5 and of 1, so that what it does before the first does not count; ours is
the median of the iterations of one run. The two take turns; medians of the turns are printed, as
wall and as CPU seconds (the latter hold on a busy machine too). The mean log-likelihoods of the
same iteration must agree, or the comparison is of different models: the program then exits with 1.
Neither side has a floor on the variances here.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
import warnings


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True, help="the built mixture_bench")
    parser.add_argument("--frames", type=int, default=106_000)
    parser.add_argument("--dimension", type=int, default=15)
    parser.add_argument("--clusters", type=int, default=1000)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("--rows", help="a float32 .npy of poses (n x d) instead of generated ones")
    return parser.parse_args()


def program_command(arguments, folder):
    command = [arguments.program]
    if arguments.rows:
        import numpy

        rows = numpy.load(arguments.rows).astype(numpy.float32)
        arguments.frames = min(arguments.frames, len(rows))
        arguments.dimension = rows.shape[1]
        path = os.path.join(folder, "given.f32")
        rows[: arguments.frames].tofile(path)
        command += ["--rows", path]
    for name in ("frames", "dimension", "clusters", "threads"):
        command += [f"--{name}", str(getattr(arguments, name))]
    return command


def read_start(arguments, folder):
    import numpy

    rows = numpy.fromfile(os.path.join(folder, "rows.f32"), dtype=numpy.float32)
    means = numpy.fromfile(os.path.join(folder, "means.f64"))
    variances = numpy.fromfile(os.path.join(folder, "variances.f64"))
    # In double, as scikit-learn would otherwise compute in float.
    return (rows.reshape(-1, arguments.dimension).astype(float),
            means.reshape(-1, arguments.dimension), variances)


def peer_fit(rows, means, variances, iterations):
    """Wall seconds, CPU seconds and the mean log-likelihood of the last iteration's E step."""
    from sklearn.mixture import GaussianMixture

    clusters = len(means)
    mixture = GaussianMixture(clusters, covariance_type="spherical", tol=0, reg_covar=0,
                              max_iter=iterations, means_init=means,
                              weights_init=[1 / clusters] * clusters,
                              precisions_init=1 / variances, init_params="random")
    wall, cpu = time.perf_counter(), time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of not having converged
        mixture.fit(rows)
    return time.perf_counter() - wall, time.process_time() - cpu, mixture.lower_bound_


def main():
    arguments = parse_arguments()
    # Before numpy is loaded: its BLAS asks once.
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ[name] = str(arguments.threads)
    with tempfile.TemporaryDirectory() as folder:
        command = program_command(arguments, folder)
        subprocess.run(command + ["--dump", folder], check=True)
        rows, means, variances = read_start(arguments, folder)
        walls, cpus, our_walls, our_cpus = [], [], [], []
        for _ in range(arguments.turns):
            wall_1, cpu_1, likelihood_1 = peer_fit(rows, means, variances, 1)
            wall_5, cpu_5, likelihood_5 = peer_fit(rows, means, variances, 5)
            walls.append((wall_5 - wall_1) / 4)
            cpus.append((cpu_5 - cpu_1) / 4)
            ours = json.loads(subprocess.run(command + ["--json", "--iterations", "5"], check=True,
                                             capture_output=True, text=True).stdout)
            our_walls.append(ours["wall"])
            our_cpus.append(ours["cpu"])
    wall, cpu = statistics.median(walls), statistics.median(cpus)
    our_wall, our_cpu = statistics.median(our_walls), statistics.median(our_cpus)
    print(f"{arguments.frames} x {arguments.dimension}, {len(means)} clusters, "
          f"{arguments.threads} threads, {arguments.turns} turns; seconds an iteration")
    print(f"scikit-learn  wall {wall:9.4f}  CPU {cpu:9.4f}")
    print(f"kinetome      wall {our_wall:9.4f}  CPU {our_cpu:9.4f}")
    print(f"ratio         wall {wall / our_wall:9.1f}  CPU {cpu / our_cpu:9.1f}")
    agree = True
    for iteration, theirs in ((1, likelihood_1), (5, likelihood_5)):
        value = ours["log_likelihoods"][iteration - 1]
        difference = abs(value - theirs) / abs(theirs)
        agree = agree and difference <= 1e-6
        print(f"mean log-likelihood, iteration {iteration}: {theirs:.9f} and {value:.9f}, "
              f"relative difference {difference:.1e}")
    if not agree:
        sys.exit("the log-likelihoods differ by more than 1e-6: not the same model")


if __name__ == "__main__":
    main()
