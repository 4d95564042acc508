#!/usr/bin/env bash
# build.sh [PRESET] [TARGET ...]: configure and build a preset (default: release) in build/PRESET.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
preset=${1:-release}
shift || true
export CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS:-pch_defines,time_macros} # what it asks for to keep precompiled headers
cmake --preset "$preset" -DCMAKE_CXX_COMPILER_LAUNCHER=ccache >&2
cmake --build --preset "$preset" ${1:+--target "$@"} >&2
