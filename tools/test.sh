# Part of ./dev: checks, tests and what measures them. Sourced after setup.sh, never run.

passed=0 failed=0 skipped=0

# check NAME COMMAND...: one check, counted like a test. Exit code 77 of the command: it cannot run.
check() {
  local name=$1 code=0
  shift
  say "check: $name ..."
  "$@" >&2 || code=$?
  case $code in
    0) passed=$((passed + 1)) ;;
    77) skipped=$((skipped + 1)) && echo "SKIPPED: $name (see above)" ;;
    *) failed=$((failed + 1)) && echo "FAILED: $name (see above)" ;;
  esac
}

sources() {
  find "$root"/{mjarm,apps,examples,python,tests} -type f \( -name '*.hpp' -o -name '*.cpp' \) | sort
}

check_layers() { python3 "$root/tools/check_layers.py" "$root"; }

check_links() { python3 -B "$root/tools/check_links.py" "$root"; }

check_format() {
  local tool found
  tool=$(clang_tool clang-format) || return 77
  found=$(sources | xargs -P "$(nproc)" -n 40 "$tool" --dry-run -Werror 2>&1) && return
  sed -n "s|^$root/\([^:]*:[0-9]*\):.*error:|\1:|p" <<<"$found" | sort -V |
    awk -F: '!seen[$1]++'  # the first fault of each file
  say "./dev format mends these"
  return 1
}

check_headers() { (configure "$1") && python3 -B "$root/tools/check_headers.py" "$root/build/$1"; }

# Skipped where its packages cannot be fetched.
check_page() {
  build_page && return
  [[ ! -e $root/web/node_modules/esbuild ]] || return 1
  return 77
}

format_sources() {
  local tool
  tool=$(clang_tool clang-format) || exit
  sources | xargs -n 40 "$tool" -i
}

tidy_sources() {
  local tool
  tool=$(clang_tool clang-tidy) || exit
  configure tidy
  { if (($#)); then realpath "$@"; else sources | grep '\.cpp$'; fi; } |
    xargs -P "$(nproc)" -n 1 "$tool" -p "$root/build/tidy" --quiet \
      --extra-arg=-Wno-unknown-warning-option 2> >(grep -v 'warnings.* generated' >&2)
}

# Starts a display of our own, so that tests of windows run anywhere and disturb nobody. -noreset: else it starts anew
# whenever its last client leaves, and refuses who comes meanwhile.
start_display() {
  local number
  command -v Xvfb >/dev/null || return 0
  coproc XVFB { exec Xvfb -displayfd 1 -noreset -screen 0 1280x1024x24 -nolisten tcp 2>/dev/null; }
  trap 'kill "$XVFB_PID" 2>/dev/null || true' EXIT
  if read -r -t 20 -u "${XVFB[0]}" number; then
    export DISPLAY=:$number
  else
    say "Xvfb did not start: tests that need a window are skipped"
  fi
}

# run_ctest PRESET [OPTION...]: runs every test, or those that options of ctest name, and adds to the
# counts.
run_ctest() {
  local folder=$root/build/$1 results=$root/build/$1/results.xml
  shift
  rm -f "$results"
  start_display
  # One more than there are processors: some tests wait, for windows and for other programs.
  ctest --test-dir "$folder" -j "$(($(jobs_at_once) + 1))" --timeout 300 "$@" --output-junit "$results" \
    --output-on-failure --no-tests=error >&2 || true
  [[ -e $results ]] || {
    check "ctest" false
    return
  }
  count_results "$results"
}

# Adds what a JUnit file holds to the counts, and says what failed or was skipped.
count_results() { count_lines "results" python3 "$root/tools/test_summary.py" "$1"; }

# count_lines NAME COMMAND...: prints what it prints, but for the last line, "PASSED FAILED SKIPPED", which adds to the counts.
count_lines() {
  local name=$1 counts
  shift
  counts=$("$@") || {
    check "$name" false
    return
  }
  sed '$d' <<<"$counts"
  read -r p f s <<<"$(tail -n 1 <<<"$counts")"
  passed=$((passed + p)) failed=$((failed + f)) skipped=$((skipped + s))
}

# run_pytest PRESET: the wheel of that build, installed, and its tests.
run_pytest() {
  local build=$root/build/$1
  find_python || { skipped=$((skipped + 1)) && echo "SKIPPED: python: no Python 3.11 with headers and venv"; return; }
  rm -rf "$build/wheel"
  check "wheel" build_wheel "$1" "$build/wheel"
  ((failed)) && return
  check "wheel: installed" test_wheel "$build/wheel" "$build/pytest.xml"
  [[ ! -e $build/pytest.xml ]] || count_results "$build/pytest.xml"
}

# run_page_tests PRESET: the page in a browser.
run_page_tests() {
  local results=$root/build/$1/page.xml code=0
  say "check: page in a browser ..."
  test_page "$1" "$results" || code=$?
  case $code in
    0) count_results "$results" ;;
    77) skipped=$((skipped + 1)) && echo "SKIPPED: page in a browser: Node 18, or what npm fetches, is not there" ;;
    *) failed=$((failed + 1)) && echo "FAILED: page in a browser (see above)" ;;
  esac
}

# run_page_and_pytest PRESET: beside each other, as each of them waits most of the time.
run_page_and_pytest() {
  local page said=$root/build/$1/page.txt
  (
    passed=0 failed=0 skipped=0
    run_page_tests "$1"
    echo "$passed $failed $skipped"
  ) >"$said" &
  page=$!
  run_pytest "$1"
  if wait "$page"; then count_lines "page in a browser" cat "$said"; else check "page in a browser" false; fi
}

run_wheel() {
  local pythons results=$root/build/wheel/pytest.xml
  rm -rf "$root/dist"
  build_whole_page || say "the wheel has no page for 'mjarm serve' and --html"
  mapfile -t pythons < <(pythons_of_wheels)
  ((${#pythons[@]})) || check "a Python of 3.11 or later, with headers" false
  for python3 in "${pythons[@]}"; do
    check "$("$python3" --version)" configure_wheel
    ((failed)) || check "build" build_counted wheel mjarm_python mjarm_python_stub
    ((failed)) || check "wheel" build_wheel wheel "$root/dist"
    ((failed)) || check "wheel: at most 16 MB" pack_wheels "$root/dist"
    ((failed)) || check "wheel: installed" test_wheel "$root/dist" "$results"
    ((failed)) && break
    count_results "$results"
  done
  ((failed)) || check "types" check_types
  if compgen -G "$root/dist/*-abi3-*.whl" >/dev/null; then check "abi3" check_abi "$root/dist"; fi
  ((failed)) || say "$(du -h "$root"/dist/*.whl)"
  finish
}

# Prints the plain last line; its exit code tells whether all is well.
finish() {
  local line="$passed passed, $failed failed"
  ((skipped)) && line+=", $skipped skipped"
  echo "$line"
  ((failed == 0))
}

build_counted() { (build "$@"); }

run_tests() {
  check "layers" check_layers
  check "links" check_links
  check "format" check_format
  check "page" check_page
  check "build" build_counted "$1" all
  if ((failed == 0)) || [[ -x $root/build/$1/bin/core_test ]]; then
    check "headers stand alone" check_headers "$1"
    check "kinematics of the page" check_ik_module "$1"
    run_ctest "$1"
    run_page_and_pytest "$1"
  fi
  finish
}

# Tests with random cases, a hundred times as many as usual; and changed files of every kind, so many
# seconds each, other ones each time.
run_long() {
  local seconds=${1:-600} parser mutate=("$root/tests/mutation/mutation_test.py" --program "$root/build/dev/bin/mjarm")
  [[ $seconds =~ ^[0-9]+$ ]] || die "long: \"$seconds\" is no whole number of seconds"
  check "build" build_counted dev all
  if ((failed == 0)); then
    MJARM_LONG_TESTS=1 run_ctest dev --tests-regex '^(kinematics|path|collision|planning|perception|rl|teleop|bench|app|whole)\.' --timeout 7200
    for parser in $(python3 -B "${mutate[@]}" --list); do
      check "changed files: $parser" python3 -B "${mutate[@]}" --parser "$parser" --seconds "$seconds" \
        --seed "$(date +%s)" --keep "$root/build/dev/mutation-found"
    done
  fi
  finish
}

run_checks_only() {
  check "layers" check_layers
  check "links" check_links
  check "format" check_format
  check "headers stand alone" check_headers dev
  finish
}

run_sanitizer() {
  # The leak check of GCC 12 and 13 takes some thread-local blocks for those of an old glibc and
  # crashes at the end of programs that load graphics drivers: google/sanitizers#1322.
  export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_stack_use_after_return=1:strict_string_checks=1:intercept_tls_get_addr=0}
  export LSAN_OPTIONS=${LSAN_OPTIONS:-suppressions=$root/tools/leaks.supp:print_suppressions=0}
  export UBSAN_OPTIONS=${UBSAN_OPTIONS:-print_stacktrace=1}
  export TSAN_OPTIONS=${TSAN_OPTIONS:-suppressions=$root/tools/races.supp}
  check "build" build_counted "$1" all
  ((failed)) || run_ctest "$1" --timeout 1200  # some tests take minutes on a busy machine
  finish
}

run_coverage() {
  set_up_packages gcovr
  check "build" build_counted coverage all
  ((failed)) || run_ctest coverage
  gcovr --root "$root" --filter "$root/mjarm/" --filter "$root/apps/" --exclude '.*_test\.cpp$' \
    --html-details "$root/build/coverage/coverage.html" --print-summary "$root/build/coverage"
  say "line by line: build/coverage/coverage.html"
  finish
}

# Public robots as users bring them; what is fetched lies in .deps and is no part of mjarm.
# run_arms [ROBOT...]: with names, those of Menagerie alone.
run_arms() {
  "$root/tools/fetch_arms.sh" "$deps/arms" || exit
  check "build" build_counted dev whole_test mjarm-bench
  ((failed == 0)) || finish || exit
  if (($# == 0)); then
    check "arms" env MJARM_ARMS_DATA="$deps/arms/robots" \
      "$root/build/dev/bin/whole_test" --gtest_filter='*TwelveArms*'
    run_ssik_arms
    run_refusals
  fi
  run_menagerie "$@"
  finish
}

# The arms that a peer ships; adds to the counts.
run_ssik_arms() {
  local python=$root/.venv/bin/python
  "$python" -c 'import ssik' 2>/dev/null || { skipped=$((skipped + 1)) && echo "SKIPPED: arms of ssik: ./dev peers installs it"; return; }
  say "check: arms of ssik ..."
  count_lines "arms of ssik" "$python" -B "$root/tools/ssik_arms.py" --program "$root/build/dev/bin/mjarm"
}

# What was once refused wrongly or answered slowly, beside its old figure; adds to the counts.
run_refusals() {
  say "check: what was refused once ..."
  count_lines "what was refused once" python3 -B "$root/tools/refusals.py" --program "$root/build/dev/bin/mjarm" --peers "$root/.venv-near"
}

# run_menagerie [ROBOT...]: every serial arm of Menagerie, or those; adds to the counts.
run_menagerie() {
  say "check: arms of Menagerie ..."
  MENAGERIE_CACHE_DIR=${MENAGERIE_CACHE_DIR:-$deps/arms/menagerie} count_lines "arms of Menagerie" \
    python3 -B "$root/tools/menagerie_arms.py" --program "$root/build/dev/bin/mjarm" --package "$deps/arms/robots/menagerie" "$@"
}

run_benches() {
  local bench
  build release benches
  compgen -G "$root/build/release/bin/*_bench" >/dev/null ||
    die "bench: nothing to run: cmake found no google-benchmark (Debian and Ubuntu: libbenchmark-dev)"
  for bench in "$root"/build/release/bin/*_bench; do "$bench"; done
}
