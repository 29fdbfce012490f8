#!/usr/bin/env bash
# Runs the commands of pages of the documentation as a reader would type them.
#   run_lines.sh PROGRAM FOLDER PLACE PAGE...
# Commands are the lines that begin with "lightwell ", within code blocks or indented by four spaces; a comment may follow. Those of a page run in an
# empty folder that has a copy of FOLDER at PLACE, so that the page's files are there and nothing is left behind. 'lightwell view' without '--offscreen' waits for a person
# and is left out. A command that ran before, on a former page, in a folder with the very same files, leaves what it left then.
set -euo pipefail
program=$1 folder=$2 place=$3
shift 3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin" && ln -s "$(realpath "$program")" "$work/bin/lightwell"
PATH=$work/bin:$PATH

# sums: the sums of all files of the page's folder, sorted.
sums() { (cd "$work/here" && find . -type f -exec sha256sum {} + | LC_ALL=C sort); }

# run_line COMMAND: runs the command, or brings the files that the command left under the same conditions.
run_line() {
  local command=$1 name
  sums >"$work/before"
  local left
  left=$work/left/$( (cat "$work/before"; echo "$command") | sha256sum | cut -d ' ' -f 1)
  if [ -d "$left" ]; then
    echo "  (ran before)"
    cp -r "$left/." "$work/here"
    return
  fi
  (cd "$work/here" && bash -c "set -e; $command" >"$work/out" 2>&1) || { cat "$work/out"; echo "failed: $command"; exit 1; }
  sums >"$work/after"
  mkdir -p "$left"
  LC_ALL=C comm -13 "$work/before" "$work/after" | cut -c 67- | while IFS= read -r name; do
    (cd "$work/here" && cp --parents "$name" "$left")
  done
}

for page in "$@"; do
  echo "$page"
  rm -rf "$work/here"
  mkdir -p "$work/here/$place" && cp -r "$folder/." "$work/here/$place"
  count=0
  while IFS= read -r line; do
    line=${line#    }
    case $line in
      "lightwell view "*) [[ $line == *--offscreen* ]] || continue ;;
      "lightwell "*) ;;
      *) continue ;;
    esac
    echo "> $line"
    run_line "${line%% #*}"
    count=$((count + 1))
  done < <(awk '/^```/ { inside = !inside; next } inside || /^    / { print }' "$page")
  echo "$count commands"
  [ $count -ge 5 ]
done
