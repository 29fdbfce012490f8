#!/usr/bin/env bash
# Says which sources clang-format would change (.clang-format; version 14, since each version formats a little otherwise).
# Exits with 1 if there are any.
#   cmake/check_format.sh          --fix: formats them
set -euo pipefail
cd "$(dirname "$0")/.."
program=$(command -v clang-format-14 || true)
if [ -z "$program" ]; then
  echo "clang-format-14 was not found, so the format is not checked."
  exit 0
fi
sources=(scene mesh radiosity raytrace standards daylight viewer design validation cli python cornell bench tests)
[ ! -d examples ] || sources+=(examples)
if [ "${1:-}" = --fix ]; then
  find "${sources[@]}" \( -name '*.h' -o -name '*.cpp' \) -print0 | xargs -0 "$program" -i
  exit 0
fi
unformatted=$(find "${sources[@]}" \( -name '*.h' -o -name '*.cpp' \) -print0 | sort -z |
  xargs -0 "$program" --dry-run 2>&1 | sed -n 's/^\([^:]*\):[0-9]*:.*/\1/p' | sort -u)
if [ -n "$unformatted" ]; then
  printf '%s\n' "$unformatted"
  echo "clang-format-14 would change these files; cmake/check_format.sh --fix does."
  exit 1
fi
echo "All sources have the format of .clang-format."
