#!/usr/bin/env bash
# Installs the build into an empty prefix, moves that prefix, and builds and runs a project against
# it: what is installed must need neither the sources nor the place it was first put.
# Usage: install_test.sh SOURCE_DIR BUILD_DIR
set -euo pipefail
source_dir=$1 build_dir=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset MUJOCO_ROOT MUJOCO_PATH LD_LIBRARY_PATH

cmake --install "$build_dir" --strip --prefix "$work/first" >"$work/install.log" ||
  { cat "$work/install.log" && exit 1; }
prefix=$work/moved
mv "$work/first" "$prefix"

# (Archives of a build with debug information name their sources, as they should.)
if grep -rlF --exclude='*.a' "$source_dir" "$prefix"; then
  echo "the files above name the source folder $source_dir"
  exit 1
fi
# README's C++ lines: the block of code below its heading.
mkdir "$work/snippet"
awk '/^## Use it from C\+\+/ { here = 1 } here && /^```$/ { exit } code { print } here && /^```cpp$/ { code = 1 }' \
  "$source_dir/README.md" >"$work/snippet/snippet.inc"
grep -q load_robot "$work/snippet/snippet.inc" || { echo "README.md has no lines for C++" && exit 1; }

cmake -S "$source_dir/tests/install_consumer" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$prefix" -DSNIPPET_DIR="$work/snippet"
cmake --build "$work/build"

# expect_tool WORDS...: the program, run with these words before it, finds the shipped models.
unset MJARM_MODELS
expect_tool() {
  local place
  place=$("$@" "$work/build/consumer" ur5e) || { echo "consumer: found no model ($*)" && exit 1; }
  [[ $place == "-0.134 0.492 0.488" ]] || { echo "consumer: wrong place of the tool: $place" && exit 1; }
}
cd /
expect_tool env
[[ $("$work/build/snippet") == "6 joints" ]] || { echo "README's lines found no model" && exit 1; }
# Nor does it need the place where it was when others were built against it.
mv "$prefix" "$work/once more"
expect_tool env LD_LIBRARY_PATH="$work/once more/lib"
expect_tool env LD_LIBRARY_PATH="$work/once more/lib" MJARM_MODELS="$source_dir/models"
mv "$work/once more" "$prefix"

# The installed program finds the installed library and models, from anywhere.
[[ -x $prefix/bin/mjarm ]] || exit 0
ldd "$prefix/bin/mjarm" | grep -F "$prefix/" | grep libmujoco
place=$("$prefix/bin/mjarm" fk --robot ur5e --in - <<<'{"q":[-1.5708,-1.5708,1.5708,-1.5708,-1.5708,0]}')
grep -q '"pos":\[-0.13' <<<"$place" || { echo "installed mjarm: fk says $place" && exit 1; }

# So are the pages to learn from, with what they link to.
page=$("$prefix/bin/mjarm" learn --json | sed -n 's/.*"file": *"\([^"]*01_set_up.md\)".*/\1/p')
[[ $page == "$prefix"/* && -e $page ]] || { echo "installed mjarm: learn names the page \"$page\"" && exit 1; }
cd "$(dirname "$page")"
for link in $(grep -oh '](\.\./[^)#]*' ./*.md | cut -c3- | sort -u); do
  [[ -e $link ]] || { echo "installed pages link to $link, which is not there" && exit 1; }
done
