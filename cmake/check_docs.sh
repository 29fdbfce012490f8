#!/usr/bin/env bash
# Checks that every page begins with a heading, that the README of a room has at most 25 lines, and that the files the
# documentation names exist: targets of links, and paths of sources in backquotes. Prints one line for each fault; exits
# with 1 if there is any.
#   cmake/check_docs.sh
set -euo pipefail
cd "$(dirname "$0")/.."
status=0
missing() { printf '%s names %s, which does not exist.\n' "$1" "$2"; status=1; }

while IFS= read -r page; do
  folder=$(dirname "$page")
  head -n 1 "$page" | grep -q '^# ' || { printf '%s does not begin with a heading.\n' "$page"; status=1; }
  case $page in
    scene/*|mesh/*|radiosity/*|raytrace/*|standards/*|daylight/*|viewer/*|design/*|validation/*|cli/*|python/*|bench/*)
      [ "$(wc -l < "$page")" -le 25 ] || { printf '%s has more than 25 lines.\n' "$page"; status=1; } ;;
  esac
  while IFS= read -r target; do
    case $target in http*|mailto:*|'') continue ;; esac
    [ -e "$folder/${target%%#*}" ] || missing "$page" "$target"
  # Outside of code blocks.
  done < <(awk '/^ *```/ { code = !code } !code' "$page" | grep -oE '\]\([^)# ]+' | sed 's/^](//')
  while IFS= read -r path; do
    [ -e "$path" ] || [ -e "$folder/$path" ] || missing "$page" "$path"
  done < <(grep -oE '`(scene|mesh|radiosity|raytrace|standards|daylight|viewer|design|validation|cli|python|cmake|tests|bench|examples)/[A-Za-z0-9_/.-]+\.(h|cpp|txt|sh|js|py)`' "$page" | tr -d '`')
done < <(find . -name '*.md' -not -path './build/*' -not -path './.git/*' | sed 's|^\./||' | sort)
[ $status = 0 ] && echo "Every page has a heading, and every file that the documentation names exists."
exit $status
