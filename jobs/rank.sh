#!/usr/bin/env bash
# rank.sh ANSWER COMMAND ...: a rank of a step. All ranks end alike, so the first one leaves its exit code in the file
# ANSWER; one that was killed leaves its own, and is a bad one to srun, which ends the step.
set -uo pipefail
trap : TERM # the command is signalled as well, and ends when its work is safe
answer=$1
shift
"$@"
code=$?
if ((SLURM_PROCID == 0 || code > 128)); then
  printf '%s\n' "$code" >"$answer"
fi
((code > 128)) || code=0
exit "$code"
