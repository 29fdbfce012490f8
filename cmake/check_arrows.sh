#!/usr/bin/env bash
# Holds every #include of the house to the tables of allowed arrows: arrows.txt for rooms, ROOM/arrows.txt for the rooms
# within one. Each line of a table names a folder and, behind a colon, the folders above it that it may include, so no
# table can hold a cycle. Prints one sentence for each arrow that is not allowed, for each one allowed that no file
# needs, for each folder that no table names, for each installed header that includes one that is not installed, and for
# each line of a library that writes to the terminal, which only programs do (cli/); exits with 1 if there is any.
#   cmake/check_arrows.sh
set -euo pipefail
cd "$(dirname "$0")/.."

# check TABLE FOLDER: FOLDER is "" for the table of rooms, else "ROOM/".
check() {
  local sources
  if [ -z "$2" ]; then
    sources=$(sed -n 's/^\([a-z_]*\):.*/\1/p' "$1")
  else
    sources=${2%/}
  fi
  # shellcheck disable=SC2086
  find $sources \( -name '*.h' -o -name '*.cpp' \) -print0 | sort -z |
    xargs -0 awk -v table="$1" -v folder="$2" '
      # The folder of a path that the table speaks of: the room for the table of rooms, else the folder below the room.
      function part(path) {
        if (folder == "") { sub(/\/.*/, "", path); return path }
        if (index(path, folder) != 1) return ""
        path = substr(path, length(folder) + 1)
        if (!sub(/\/[^\/]*$/, "", path)) return "."
        return path
      }
      function complain(sentence) { print sentence; failed = 1 }
      BEGIN {
        while ((getline line < table) > 0) {
          if (line ~ /^#/ || line == "") continue
          colon = index(line, ":")
          from = substr(line, 1, colon - 1)
          n = split(substr(line, colon + 1), to, " ")
          for (i = 1; i <= n; ++i) {
            if (!(to[i] in known)) complain(table ": " from " may include " to[i] ", which no line above it names.")
            allowed[from, to[i]] = 1
          }
          known[from] = 1
        }
      }
      FNR == 1 {
        here = part(FILENAME)
        if (!(here in known) && !(here in missing)) {
          complain(table ": " here " is missing (" FILENAME " lies in it).")
          missing[here] = 1
        }
      }
      /^#include "/ {
        split($0, piece, "\"")
        there = part(piece[2])
        if (there == "" || there == here || (folder == "" && !(there in known))) next
        if ((here, there) in allowed) used[here, there] = 1
        else complain(FILENAME ":" FNR ": " here " may not include " there " (" piece[2] "; " table ").")
      }
      END {
        for (arrow in allowed) {
          split(arrow, end, SUBSEP)
          if (!(arrow in used)) complain(table ": no file of " end[1] " includes " end[2] "; take the arrow out.")
        }
        exit failed
      }'
}

status=0
check arrows.txt "" || status=1
for table in */arrows.txt; do
  check "$table" "${table%arrows.txt}" || status=1
done
libraries=(scene mesh radiosity standards daylight raytrace viewer design validation)
installed=$(for room in "${libraries[@]}"; do
  awk -v room="$room" '/^  HEADERS /{ on = 1 } /^  SOURCES/{ on = 0 }
    on { for (i = 1; i <= NF; ++i) if ($i ~ /\.h$/) print room "/" $i }' "$room/CMakeLists.txt"
done)
# shellcheck disable=SC2086
if hidden=$(grep -oE '^#include "[^"]*"' $installed /dev/null | sed 's/:#include "/ /; s/"$//' |
    awk -v installed="$installed" 'BEGIN { n = split(installed, name); for (i = 1; i <= n; ++i) is_installed[name[i]] = 1 }
      !($2 in is_installed) { print $1 " is installed, and includes " $2 ", which is not."; found = 1 }
      END { exit !found }'); then
  printf '%s\n' "$hidden"
  status=1
fi
if written=$(grep -rnE --include='*.h' --include='*.cpp' \
    '\bstd(err|out)\b|std::(cerr|cout|clog)|\b(f?printf|puts|perror)\(|fmt::print\("' "${libraries[@]}"); then
  printf '%s\n' "$written" | sed 's/^\([^:]*:[0-9]*\):.*/\1: a library may not write to the terminal./'
  status=1
fi
[ $status = 0 ] && echo "Every #include follows the tables of arrows, installed headers are complete, and no library writes to the terminal."
exit $status
