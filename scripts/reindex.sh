#!/usr/bin/env bash
# reindex.sh [CORPUS] [STORE]: install, build and index a folder of takes.
# Without CORPUS a small corpus is generated first, so that there is something to look at.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
corpus=${1:-$root/build/corpus}
store=${2:-$root/build/store}

"$root/scripts/setup.sh"
"$root/scripts/build.sh" release kinetome
kinetome=$root/build/release/kinetome

if [ $# -eq 0 ] && [ ! -d "$corpus" ]; then
  "$kinetome" generate --frames 30000 --subjects 3 --seed 1 -o "$corpus" # appears whole or not at all
fi
status=0
"$kinetome" reindex "$corpus" --store "$store" || status=$?
[ "$status" -eq 0 ] || [ "$status" -eq 3 ] || exit "$status" # 3: published, some takes quarantined
"$kinetome" info "$store"
exit "$status"
