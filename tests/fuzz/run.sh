# What tests/run --fuzz does. To be sourced by bash behind cmake/setup.sh, with the repository root as the working directory.

# The same clang on Debian 12 and 13, its sanitizers and libFuzzer, and what names the functions in their reports.
fuzz_packages=(clang-19 libclang-rt-19-dev llvm-19)
most_findings=5  # of a target, which then ends

# seconds_of TIME: 90s, 10min, 2h.
seconds_of() {
  [[ $1 =~ ^([1-9][0-9]{0,5})(s|min|h)$ ]] || die "--fuzz takes a time such as 90s, 10min or 2h, not '$1'."
  case ${BASH_REMATCH[2]} in
    s) echo "${BASH_REMATCH[1]}" ;;
    min) echo $((60 * BASH_REMATCH[1])) ;;
    h) echo $((3600 * BASH_REMATCH[1])) ;;
  esac
}

# words_of FOLDER: the string literals of a reader, which are the words of its format, as a dictionary of libFuzzer.
words_of() { grep -ohE '"[A-Za-z_?!#<][A-Za-z0-9_.:=-]{1,30}"' "$1"/*.cpp | sort -u; }

# fuzz_target NAME SECONDS SOURCES: one row of the table. The files that reach new edges go to build/fuzz/corpus, from
# where the next run goes on.
fuzz_target() {
  local name=$1 seconds=$2 sources=$3
  local findings=build/fuzz/findings/$name grown=build/fuzz/corpus/$name log=build/fuzz/logs/$name.log
  mkdir -p "$findings" "$grown" build/fuzz/logs
  # More at once than the pixels of the largest picture (400 MB, of which an even one has 12 kB) is out of proportion.
  local options=(-max_len=16384 -malloc_limit_mb=512 -rss_limit_mb=2048 -timeout=25 -report_slow_units=25
    -print_final_stats=1 -artifact_prefix="$findings/")
  [ "$name" != solution ] || options+=(-max_len=65536)  # the smallest has 20 kB
  if [ -n "$sources" ]; then
    words_of "$sources" >"build/fuzz/logs/$name.dict"
    options+=(-dict="build/fuzz/logs/$name.dict")
  fi
  local begin=$SECONDS found=0 left=$seconds
  : >"$log"
  while [ "$found" -lt $most_findings ] && [ "$left" -gt 0 ]; do
    if nice build/fuzz/tests/fuzz/lightwell_fuzz --target="$name" "${options[@]}" -max_total_time=$left \
      "$grown" "tests/fuzz/corpus/$name" >>"$log" 2>&1 </dev/null; then
      break
    fi
    found=$((found + 1))
    left=$((seconds - SECONDS + begin))
  done
  local runs edges took=$((SECONDS - begin))
  runs=$(awk '/^stat::number_of_executed_units/ { sum += $2 } END { print sum + 0 }' "$log")
  edges=$(awk '{ for (i = 1; i < NF; ++i) if ($i == "cov:") edges = $(i + 1) } END { print edges + 0 }' "$log")
  printf "$row" "$name" "$runs" $((runs / (took > 0 ? took : 1))) "$edges" "$found"
  all_findings=$((all_findings + found))
}

# fuzz TIME [TARGET...]: runs all targets, or those named, for the time in all. Exits with 1 if there is a finding.
fuzz() {
  local seconds all chosen name sources each
  seconds=$(seconds_of "${1:-}")
  shift
  use_preset fuzz
  need_packages "${build_packages[@]}" "${fuzz_packages[@]}"
  configure
  build lightwell_fuzz
  all=$(build/fuzz/tests/fuzz/lightwell_fuzz --targets)
  chosen=("$@")
  [ $# -gt 0 ] || mapfile -t chosen < <(awk '{ print $1 }' <<<"$all")
  for name in "${chosen[@]}"; do
    awk -v name="$name" '$1 == name { found = 1 } END { exit !found }' <<<"$all" ||
      die "there is no target '$name'; there are $(awk '{ printf "%s%s", separator, $1; separator = ", " }' <<<"$all")."
  done
  each=$((seconds / ${#chosen[@]}))
  [ $each -ge 1 ] || each=1

  # Files of the readers lie in memory where there is a file system for that.
  local place=${TMPDIR:-/tmp}
  [ ! -w /dev/shm ] || place=/dev/shm
  TMPDIR=$(mktemp -d -p "$place" lightwell-fuzz-run-XXXXXX)
  export TMPDIR
  trap 'rm -rf "$TMPDIR"' EXIT
  trap 'exit 130' INT TERM
  export ASAN_OPTIONS="quarantine_size_mb=64:${ASAN_OPTIONS:-}" ASAN_SYMBOLIZER_PATH=/usr/bin/llvm-symbolizer-19
  export LSAN_OPTIONS="suppressions=tests/fuzz/leaks.txt:print_suppressions=0:${LSAN_OPTIONS:-}"
  export UBSAN_OPTIONS="print_stacktrace=1:halt_on_error=1:${UBSAN_OPTIONS:-}"

  say "Fuzzing ${#chosen[@]} targets, $each s each"
  local row='%-12s %12s %10s %8s %9s\n' all_findings=0
  # shellcheck disable=SC2059
  printf "$row" target executions per-second edges findings
  for name in "${chosen[@]}"; do
    sources=$(awk -v name="$name" '$1 == name { print $2 }' <<<"$all")
    fuzz_target "$name" "$each" "$sources"
  done
  [ $all_findings -eq 0 ] || die "there are $all_findings findings, in build/fuzz/findings/TARGET. What was wrong with each is at the
end of build/fuzz/logs/TARGET.log, and build/fuzz/tests/fuzz/lightwell_fuzz --target=TARGET FILE shows it again."
}
