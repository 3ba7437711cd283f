#!/usr/bin/env bash
# A machine that has GoogleTest without GoogleMock (Debian has a package for each, and one often comes
# with other software) must configure: the release build has no tests and looks for none, a build that
# takes them if it can leaves them out, and one that needs them says what is missing.
# Usage: half_gtest_test.sh SOURCE_DIR MUJOCO_ROOT
set -euo pipefail
source_dir=$1 mujoco=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
  echo "half_gtest_test: $*"
  cat "$work/log"
  exit 1
}
mkdir "$work/gtest"
cat >"$work/gtest/GTestConfig.cmake" <<'END'
message(STATUS "looked for GoogleTest")
add_library(GTest::gtest INTERFACE IMPORTED)
add_library(GTest::gtest_main INTERFACE IMPORTED)
END
configure() {
  local folder=$1
  shift
  cmake -S "$source_dir" -B "$work/$folder" -DMUJOCO_ROOT="$mujoco" -DGTest_DIR="$work/gtest" "$@" >"$work/log" 2>&1
}
configure release --preset release || fail "the release build does not configure"
! grep -q "looked for GoogleTest" "$work/log" || fail "the release build looks for tests"
configure auto -G Ninja -DMJARM_TESTS=AUTO || fail "a build that takes tests if it can does not configure"
grep -q "the tests are left out" "$work/log" || fail "nobody is told that the tests are left out"
if configure needed -G Ninja -DMJARM_TESTS=ON; then fail "a build that needs tests configures without them"; fi
grep -q "install libgmock-dev" "$work/log" || fail "nobody is told what is missing"
