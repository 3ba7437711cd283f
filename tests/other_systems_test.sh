#!/usr/bin/env bash
# Where mjarm does not run one line says so, before anything is looked for or fetched: configuring on macOS (without a
# compiler too) and for it, and ./dev on all but Linux; and README says the same in both languages.
# Usage: other_systems_test.sh SOURCE_DIR
set -euo pipefail
source_dir=$1
fail() {
  echo "other_systems_test: $*"
  exit 1
}
system_file=$source_dir/cmake/MjarmSystem.cmake
cmake -P "$system_file" || fail "this machine is refused"
cmake -DCMAKE_SYSTEM_NAME=Windows -P "$system_file" || fail "Windows is refused"
for other in CMAKE_HOST_APPLE=1:macOS CMAKE_SYSTEM_NAME=Darwin:Darwin; do
  if said=$(cmake "-D${other%:*}" -P "$system_file" 2>&1); then fail "${other#*:} is taken"; fi
  tr -s ' \n' ' ' <<<"$said" | grep -q "for Linux .* and for Windows so far, not for ${other#*:}" || fail "${other#*:}: $said"
done
# It is asked before a compiler is.
[[ $(grep -nm1 MjarmSystem "$source_dir/CMakeLists.txt" | cut -d: -f1) -lt \
  $(grep -nm1 '^project(' "$source_dir/CMakeLists.txt" | cut -d: -f1) ]] || fail "project() comes first"

for type in darwin23 msys cygwin; do
  if said=$(OSTYPE=$type "$source_dir/dev" doctor 2>&1); then fail "./dev runs on $type"; fi
  [[ $said == "dev: ./dev runs on Linux, not on $type;"* ]] || fail "./dev on $type: $said"
done
for word in WSL2 macOS Windows; do
  for file in README.md README.zh-CN.md; do grep -q "^| .*$word" "$source_dir/$file" || fail "$file: no word of $word"; done
done
