#!/usr/bin/env bash
# Runs the commands of a page of the documentation as a reader would type them.
#   run_lines.sh PROGRAM PAGE FOLDER PLACE
# Commands are the lines that begin with "lightwell ", within code blocks or indented by four spaces; a comment may follow. They run in an
# empty folder that has a copy of FOLDER at PLACE, so that the page's files are there and nothing is left behind. 'lightwell view' without '--offscreen' waits for a person
# and is left out.
set -euo pipefail
program=$1 page=$2 folder=$3 place=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin" && ln -s "$(realpath "$program")" "$work/bin/lightwell"
mkdir -p "$work/here/$place" && cp -r "$folder/." "$work/here/$place"
PATH=$work/bin:$PATH
count=0
while IFS= read -r line; do
  line=${line#    }
  case $line in
    "lightwell view "*) [[ $line == *--offscreen* ]] || continue ;;
    "lightwell "*) ;;
    *) continue ;;
  esac
  echo "> $line"
  (cd "$work/here" && bash -c "set -e; ${line%% #*}" >"$work/out" 2>&1) || { cat "$work/out"; echo "failed: $line"; exit 1; }
  count=$((count + 1))
done < <(awk '/^```/ { inside = !inside; next } inside || /^    / { print }' "$page")
echo "$count commands"
[ $count -ge 5 ]
