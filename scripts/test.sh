#!/usr/bin/env bash
# test.sh: install, check the formatting, build, run all tests, and the quick ones under sanitizers.
# Tests on real motion run when KINETOME_TEST_CORPUS names a folder with cmu/ and labels/; those of the job scripts
# when KINETOME_TEST_SLURM=1 and KINETOME_TEST_MINI_SLURM names a cluster of tests/support/mini-slurm (.ci/run).
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"

scripts/setup.sh
scripts/format.sh --check
scripts/build.sh mpi # runs serially, too
ctest --preset mpi -j "$(($(nproc) + 1))" # those of the job scripts mostly wait
scripts/build.sh asan sanitized_tests
ctest --preset asan -j "$(nproc)"
scripts/build.sh tsan threaded_tests
ctest --preset tsan -j "$(nproc)"
