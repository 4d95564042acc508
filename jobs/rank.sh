#!/usr/bin/env bash
# rank.sh EXIT_FILE COMMAND ...: a rank of a step. The first one leaves its exit code; to srun all orderly ends are
# alike, and a rank that was killed is a bad one that ends the step (see run_step in lib.sh).
set -uo pipefail
trap : TERM # the command is signalled as well, and ends when its work is safe
exit_file=$1
shift
"$@"
code=$?
((SLURM_PROCID > 0)) || printf '%s\n' "$code" >"$exit_file"
((code > 128)) || code=0
exit "$code"
