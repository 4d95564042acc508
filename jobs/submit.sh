#!/usr/bin/env bash
# submit.sh CORPUS STORE [OPTION ...] [-- REINDEX-OPTION ...]: indexes a folder of takes as Slurm jobs:
# an array that reads the takes, one MPI job for all other stages, one that publishes.
#
#   --nodes N            nodes of the MPI job (default: Slurm's choice)
#   --ranks N            ranks of the MPI job (default: as `kinetome plan` advises)
#   --time LIMIT         time limit of each job, as sbatch has it (default: as `kinetome plan` advises)
#   --account A, --partition P, --constraint C    as sbatch has them, for all jobs
#   --max-requeues N     how often a job that was interrupted begins anew (default: 5)
#   --node-scratch DIR   folder on every node's own disk where files are written first
#   --wait               wait for the end, tell what happens, exit as the publish job does
#
# What follows `--` are options of `kinetome reindex`, such as --preset paper. KINETOME names the program, if it
# is neither beside this script, nor in its installation or build tree, nor on the PATH.
set -euo pipefail
unset "${!SLURM_ARRAY_@}" SLURM_RESTART_COUNT # of a job that this may run in; its jobs would inherit them
jobs=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)

die() { # CODE MESSAGE
  printf 'submit.sh: %s\n' "$2" >&2
  exit "$1"
}

find_kinetome() {
  local candidate
  for candidate in "${KINETOME:-}" "$jobs/kinetome" "$jobs/../../../bin/kinetome" "$jobs/../build/mpi/kinetome" \
    "$jobs/../build/release/kinetome" "$(type -P kinetome || true)"; do
    [[ -n $candidate && -x $candidate ]] || continue
    realpath -- "$candidate"
    return
  done
  die 64 "no program kinetome found: set KINETOME to its path"
}

# --- arguments
paths=() common=() mpi=() stage=() options=()
ranks='' nodes='' time='' max_requeues=5 wait=false
while (($#)); do
  case $1 in
    -h | --help) sed -n '2,/^set /{/^set /d;s/^# \{0,1\}//;p}' "${BASH_SOURCE[0]}"; exit 0 ;;
    --wait) wait=true; shift; continue ;;
    --) shift; options=("$@"); break ;;
    --*) (($# > 1)) || die 64 "$1 needs a value" ;;
    *) paths+=("$1"); shift; continue ;;
  esac
  case $1 in
    --nodes) nodes=$2 ;;
    --ranks) ranks=$2 ;;
    --time) time=$2 ;;
    --max-requeues) max_requeues=$2 ;;
    --account | --partition | --constraint) common+=("$1=$2") ;;
    --node-scratch) stage+=(--node-scratch "$2") ;;
    *) die 64 "no option is called $1; --help lists them" ;;
  esac
  shift 2
done
((${#paths[@]} == 2)) || die 64 "needs CORPUS and STORE; --help tells more"
[[ ${nodes:-1} =~ ^[1-9][0-9]*$ && ${ranks:-1} =~ ^[1-9][0-9]*$ && $max_requeues =~ ^[0-9]+$ ]] ||
  die 64 "--nodes, --ranks and --max-requeues are whole numbers"
for option in "${options[@]}"; do
  [[ ! $option =~ ^--(only|copy)(=|$) ]] || die 64 "$option is not for a chain of jobs, which makes everything and links"
done
corpus=$(realpath -- "${paths[0]}")
store=$(realpath -m -- "${paths[1]}")
[[ $store != *\\* ]] || die 64 "Slurm cannot write logs below a folder with a backslash in its name: $store"
kinetome=$(find_kinetome)
for program in sbatch squeue scontrol; do
  type -P "$program" >/dev/null || die 73 "$program is not here: run this where Slurm jobs are submitted"
done

# --- open the run; what the jobs will need
declare -A need=()
plan=$("$kinetome" plan "$corpus" --store "$store" --open --format shell ${ranks:+--ranks "$ranks"} "${options[@]}")
while IFS='=' read -r name value; do
  [[ $name =~ ^[a-z_]+$ && $value =~ ^[0-9:]+$ ]] || die 70 "kinetome plan: unexpected line: $name=$value"
  need[$name]=$value
done <<<"$plan"
ranks=${ranks:-${need[ranks]}}
((ranks >= ${nodes:-1})) || ranks=$nodes # no node without a rank
[[ -z $nodes ]] || mpi+=(--nodes="$nodes")

logs=$store/scratch/jobs
mkdir -p -- "$logs"
log_pattern=${logs//%/%%}

# --- submit the chain, or nothing
submitted=()
submit() { # NAME LOG SBATCH-ARGUMENT ...: sets the variable NAME to the job's id
  local name=$1 log=$2 id
  shift 2
  if ! id=$(sbatch --parsable --output="$log_pattern/$log" --kill-on-invalid-dep=yes "${common[@]}" "$@"); then
    ((${#submitted[@]} == 0)) || scancel "${submitted[@]}"
    die 73 "Slurm did not take the $name job; nothing is left of the others"
  fi
  id=${id%%;*} # a federation adds the cluster's name
  submitted+=("$id")
  printf -v "$name" %s "$id"
}
submit ingest ingest-%A_%a.log --array="1-${need[ingest_tasks]}" --cpus-per-task="${need[ingest_threads]}" \
  --mem="${need[ingest_memory_mb]}" --time="${time:-${need[ingest_time]}}" \
  "$jobs/ingest_array.sbatch" "$jobs" "$kinetome" "$max_requeues" "${need[ingest_tasks]}" \
  "$corpus" "$store" "${stage[@]}"
submit reindex reindex-%j.log --dependency="afterok:$ingest" --ntasks="$ranks" "${mpi[@]}" \
  --cpus-per-task="${need[threads]}" --mem-per-cpu=$(((need[memory_mb] + need[threads] - 1) / need[threads])) \
  --time="${time:-${need[time]}}" \
  "$jobs/reindex.sbatch" "$jobs" "$kinetome" "$max_requeues" "$corpus" "$store" "${stage[@]}"
submit publish publish-%j.log --dependency="afterok:$reindex" --cpus-per-task="${need[ingest_threads]}" \
  --mem="${need[ingest_memory_mb]}" --time="${time:-${need[time]}}" \
  "$jobs/publish.sbatch" "$kinetome" "$store"

printf '%s\n' "${need[frames]} frames, ${need[disk_mb]} MiB of disk at most" \
  "ingest   job $ingest: ${need[ingest_tasks]} tasks of ${need[ingest_threads]} threads" \
  "reindex  job $reindex: $ranks ranks of ${need[threads]} threads" \
  "publish  job $publish" \
  "logs     $logs"
if $wait; then
  exec "$jobs/wait.sh" "$store" "$ingest" "$reindex" "$publish"
fi
printf '%s\n' "look     squeue --jobs=$ingest,$reindex,$publish" \
  "wait     $(printf '%q ' "$jobs/wait.sh" "$store" "$ingest" "$reindex" "$publish")" \
  "cancel   scancel $ingest $reindex $publish"
