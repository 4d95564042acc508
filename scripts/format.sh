#!/usr/bin/env bash
# format.sh [--check]: format all C++ sources, or say which are not formatted.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
mode=(-i)
[ "${1:-}" = --check ] && mode=(--dry-run --Werror)
find include src tests bench -name '*.h' -print0 -o -name '*.cpp' -print0 | xargs -0 clang-format "${mode[@]}"
