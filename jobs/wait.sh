#!/usr/bin/env bash
# wait.sh STORE INGEST REINDEX PUBLISH: waits for jobs that submit.sh submitted, tells each change of their states,
# and exits as the publish job does, or as the job does that kept it from running.
set -euo pipefail
logs=$1/scratch/jobs
declare -A job=([ingest]=$2 [reindex]=$3 [publish]=$4) told=()
poll_seconds=${KINETOME_POLL_SECONDS:-10}
failed='^(FAILED|CANCELLED|TIMEOUT|NODE_FAIL|OUT_OF_MEMORY|BOOT_FAIL|DEADLINE|PREEMPTED)$'

say() { TZ=UTC printf '%(%FT%TZ)T %s\n' -1 "$*"; }

# Lines "JOB TASK STATE REASON", the tasks of an array one by one. Slurm forgets jobs minutes after their end.
list_jobs() {
  squeue --noheader --array --states=all --jobs="${job[ingest]},${job[reindex]},${job[publish]}" --format='%F %K %T %r'
}

# "3 COMPLETED, 1 RUNNING": the tasks of a stage; why it is pending is told as well.
summary() { # STAGE
  awk -v job="${job[$1]}" '$1 == job { print $3 == "PENDING" ? $3 " (" $4 ")" : $3 }' <<<"$list" |
    sort | uniq -c | sed 's/^ *//' | paste -sd '|' | sed 's/|/, /g'
}

tell_changes() {
  local stage now
  for stage in ingest reindex publish; do
    now=$(summary "$stage")
    [[ -n $now && $now != "${told[$stage]:-}" ]] || continue
    told[$stage]=$now
    say "$stage (job ${job[$stage]}): $now"
  done
}

# The program's, 0 when it was killed or cancelled.
exit_code_of() { # JOB
  { scontrol show job --oneliner "$1" || true; } | sed -n 's/.* ExitCode=\([0-9]*\):.*/\1/p' | head -n 1
}

# Ends with the publish job's exit code, if it has one.
report_publication() {
  local log=$logs/publish-${job[publish]}.log code=''
  case $(summary publish) in
    '1 COMPLETED') code=0 ;;
    '1 FAILED') code=$(exit_code_of "${job[publish]}") ;;
    '') code=$(cat -- "$logs/publish-${job[publish]}.exit" || true) ;; # forgotten
  esac
  case $code in
    0) [[ $(summary publish) != '1 FAILED' ]] || return 0; say "published: see $log" ;;
    3) say "published; some takes are quarantined: see $log" ;;
    ?*) say "job ${job[publish]} (publish) failed with exit code $code: see $log" ;;
    *) return 0 ;;
  esac
  exit "$code"
}

# Names the first task that failed on its own account, not for a dependency. Exit code 75: to be submitted again.
report_failure() {
  local stage id task code
  for stage in ingest reindex publish; do
    task=$(awk -v job="${job[$stage]}" -v failed="$failed" \
      '$1 == job && $3 ~ failed && $4 != "DependencyNeverSatisfied" { print $2; exit }' <<<"$list")
    [[ -n $task ]] || continue
    id=${job[$stage]}
    [[ $task == N/A ]] || id+=_$task
    say "job $id ($stage) failed: see $logs/$stage-$id.log; its dependents were cancelled"
    code=$(exit_code_of "$id")
    ((code > 0)) || code=75
    exit "$code"
  done
  say "the publish job ended without a result: see $logs"
  exit 75
}

while :; do
  if list=$(list_jobs); then
    tell_changes
    unfinished=$(awk -v job="${job[publish]}" -v failed="$failed" \
      '$1 == job && $3 != "COMPLETED" && $3 !~ failed { print $3 }' <<<"$list")
    if [[ -z $unfinished ]]; then
      report_publication
      report_failure
    fi
  fi
  sleep "$poll_seconds"
done
