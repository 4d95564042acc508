# lib.sh: what the job scripts share. They set jobs, store and max_requeues, and source it.

# A time limit or `scancel` signals the program as well: its answer, not this shell's end, decides.
trap : TERM

# This job; its number alone would name all tasks of an array.
job=$SLURM_JOB_ID
[[ -z ${SLURM_ARRAY_JOB_ID:-} ]] || job=${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID

say() { TZ=UTC printf '%(%FT%TZ)T %s\n' -1 "$*"; }

# Not after it was cancelled or preempted: others have decided then what becomes of it.
is_running() {
  [[ $(squeue --noheader --jobs="$job" --format=%T) == RUNNING ]]
}

# run_step NAME COMMAND ...: runs it as the job's ranks, and returns what they answered (rank.sh). srun's own exit
# code does not tell enough: where a rank cannot be started, as on a node that crashed and came back, it may be 0.
run_step() {
  local answer=$store/scratch/jobs/$1-$job.exit attempt code
  shift
  for attempt in 1 2 3; do
    code=0
    rm -f -- "$answer"
    srun --mpi="${KINETOME_SRUN_MPI:-pmix}" --kill-on-bad-exit=1 --cpus-per-task="$SLURM_CPUS_PER_TASK" \
      "$jobs/rank.sh" "$answer" "$@" || code=$?
    if [[ -s $answer ]]; then
      return "$(<"$answer")"
    fi
    say "srun ended with $code, without an answer of the ranks (attempt $attempt)"
    is_running || break
  done
  ((code > 1)) || code=70
  return "$code"
}

# run_stage NAME COMMAND ...: runs a stage, and ends the job as its exit code asks.
run_stage() {
  local restarts=${SLURM_RESTART_COUNT:-0} code=0
  say "job $job on $SLURM_JOB_NODELIST, start $((restarts + 1))"
  run_step "$@" || code=$?
  case $code in
    0 | 3) # 3: some takes are quarantined; the publish job says so again
      say "done"
      exit 0
      ;;
    75)
      if ! is_running; then
        say "ended by a cancellation or preemption; finished work is kept"
        exit 75
      fi
      if ((restarts >= max_requeues)); then
        say "interrupted once more after $restarts requeues, as many as are allowed; finished work is kept: submit again"
        exit 75
      fi
      say "interrupted; requeue $((restarts + 1)) of at most $max_requeues"
      scontrol requeue "$job"
      sleep 600 # until Slurm ends this script
      exit 75
      ;;
    *)
      say "failed with exit code $code"
      exit "$code"
      ;;
  esac
}
