#!/usr/bin/env bash
# Tests of ./dev that build nothing. Usage: dev_test.sh SOURCE_DIR
set -euo pipefail
source_dir=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
  echo "dev_test: $*"
  exit 1
}

"$source_dir/dev" | grep -q './dev demo ellipse' || fail "alone it must show how it is used"
[[ $("$source_dir/dev") == "$("$source_dir/dev" help)" ]] || fail "help differs"

# A copy of the script alone, with stand-ins for what it calls.
mkdir -p "$work/mjarm/tools" "$work/mjarm/build/release/bin" "$work/bin" "$work/elsewhere"
cp "$source_dir/dev" "$work/mjarm/"
cp "$source_dir"/tools/*.sh "$work/mjarm/tools/"
cd "$work/mjarm"
mkdir -p apps cmake mjarm .deps/mujoco-core-4.0.1
touch CMakeLists.txt CMakePresets.json
printf '#!/bin/sh\necho "in $PWD:" "$@"\nexit 3\n' >build/release/bin/mjarm
chmod +x build/release/bin/mjarm
touch build/release/.dev-built-mjarm
ln -s "$work/mjarm/dev" "$work/bin/dev-link"
cd "$work/elsewhere"

unset MUJOCO_ROOT
code=0
answer=$("$work/bin/dev-link" fk "a b" --x) || code=$?
[[ $answer == "in $work/elsewhere: fk a b --x" ]] || fail "arguments or directory: $answer"
[[ $code == 3 ]] || fail "the exit code of the program is lost: $code"

# A machine without packages: reported, not changed.
printf '#!/bin/sh\nexit 1\n' >"$work/bin/dpkg-query"
printf '#!/bin/sh\ntouch %s/apt-called\n' "$work" | tee "$work/bin/apt-get" >"$work/bin/sudo"
chmod +x "$work/bin/"*
sleep 0.01
touch "$work/mjarm/mjarm/new.cpp"
for arguments in "--no-install" "--no-install fk" "--no-install test" "--no-install docs"; do
  code=0
  answer=$(PATH="$work/bin:$PATH" "$work/mjarm/dev" $arguments 2>&1) || code=$?
  [[ $code == 1 ]] || fail "$arguments: exit code $code: $answer"
  grep -q 'apt-get install .*libeigen3-dev' <<<"$answer" || fail "$arguments: no apt line: $answer"
done
[[ ! -e $work/apt-called ]] || fail "--no-install called apt-get or sudo"

# A download that is not what it should be never arrives; a machine without network is told so.
cat >"$work/bin/dpkg-query" <<'END'
#!/bin/sh
shift 2
for name in "$@"; do echo "ii  $name"; done
END
cat >"$work/bin/python3" <<'END'
#!/bin/sh
case "$*" in *--version*) exit 0 ;; esac
[ -z "$NO_NETWORK" ] || exit 1
while [ "$1" != --dest ]; do shift; done
echo "something else" >"$2/mujoco_core-4.0.1-cp311.whl"
END
chmod +x "$work/bin/python3"
rmdir "$work/mjarm/.deps/mujoco-core-4.0.1"
code=0
answer=$(PATH="$work/bin:$PATH" "$work/mjarm/dev" fk 2>&1) || code=$?
[[ $code == 1 ]] || fail "wrong download: exit code $code: $answer"
grep -q 'SHA-256 differs' <<<"$answer" || fail "wrong download: $answer"
code=0
answer=$(NO_NETWORK=yes PATH="$work/bin:$PATH" "$work/mjarm/dev" fk 2>&1) || code=$?
[[ $code == 1 ]] || fail "no network: exit code $code: $answer"
grep -q 'package index reachable' <<<"$answer" || fail "no network: $answer"
left=$(find "$work/mjarm/.deps" -mindepth 1 ! -name lock)
[[ -z $left ]] || fail "left behind: $left"
