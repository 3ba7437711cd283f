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

export LC_ALL=C
"$source_dir/dev" | grep -q './dev demo ellipse' || fail "alone it must show how it is used"
[[ $("$source_dir/dev") == "$("$source_dir/dev" help)" ]] || fail "help differs"
in_chinese() { env -u LC_ALL -u LC_MESSAGES LANG=zh_CN.UTF-8 "$@"; }
commands_named() { sed -n 's/^  \(\.\/dev [a-z|]*\).*/\1/p'; }
[[ $("$source_dir/dev" | commands_named) == "$(in_chinese "$source_dir/dev" | commands_named)" ]] || fail "the help in Chinese names other commands"

# A copy of the script alone, with stand-ins for what it calls.
mkdir -p "$work/mjarm/tools" "$work/mjarm/build/release/bin" "$work/bin" "$work/elsewhere"
cp "$source_dir/dev" "$work/mjarm/"
cp "$source_dir"/tools/*.sh "$work/mjarm/tools/"
cd "$work/mjarm"
mkdir -p apps cmake mjarm .deps/mujoco-core-4.0.1
touch CMakeLists.txt CMakePresets.json
printf '#!/bin/sh\necho "in $PWD:" "$@"\necho "called as $MJARM_CALLED_AS" >&2\nexit 3\n' >build/release/bin/mjarm
chmod +x build/release/bin/mjarm
touch build/release/.dev-built-mjarm
note_libraries() { (shopt -s nullglob && echo /usr/include/{ompl*,apriltag*,benchmark*}/) >"$work/mjarm/build/release/.dev-libraries"; }
note_libraries
ln -s "$work/mjarm/dev" "$work/bin/dev-link"
cd "$work/elsewhere"

unset MUJOCO_ROOT
code=0
answer=$("$work/bin/dev-link" fk "a b" --x 2>"$work/said") || code=$?
[[ $answer == "in $work/elsewhere: fk a b --x" ]] || fail "arguments or directory: $answer"
[[ $(<"$work/said") == "called as $work/bin/dev-link" ]] || fail "the name that hints give: $(<"$work/said")"
[[ $code == 3 ]] || fail "the exit code of the program is lost: $code"

# Help builds nothing, and no argument is left unread.
[[ $("$work/mjarm/dev" arms --help 2>&1) == "$("$source_dir/dev")" ]] || fail "arms --help is not the help"
code=0
answer=$("$work/mjarm/dev" test kinematics 2>&1) || code=$?
[[ $code == 2 && $answer == *"'kinematics'"* ]] || fail "test kinematics: exit code $code: $answer"
code=0
answer=$("$work/mjarm/dev" build release asan 2>&1) || code=$?
[[ $code == 2 && $answer == *"'asan'"* ]] || fail "build release asan: exit code $code: $answer"

# A machine without packages: reported, not changed.
printf '#!/bin/sh\nexit 1\n' >"$work/bin/dpkg-query"
printf '#!/bin/sh\ntouch %s/apt-called\n' "$work" | tee "$work/bin/apt-get" >"$work/bin/sudo"
cat >"$work/bin/apt-cache" <<'END'
#!/bin/sh
shift
for name in "$@"; do printf '%s:\n  Candidate: 1\n' "$name"; done
END
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
answer=$(in_chinese PATH="$work/bin:$PATH" "$work/mjarm/dev" --no-install fk 2>&1) || true
grep -q '缺少系统软件包：.*libeigen3-dev' <<<"$answer" || fail "in Chinese: $answer"

# A library that is built in where it is found came since: looked at anew, though no source has changed.
rm "$work/mjarm/mjarm/new.cpp"
touch "$work/mjarm/build/release/.dev-built-mjarm"
answer=$("$work/mjarm/dev" fk 2>/dev/null) || true
[[ $answer == *": fk" ]] || fail "up to date, but: $answer"
echo others >"$work/mjarm/build/release/.dev-libraries"
answer=$(PATH="$work/bin:$PATH" "$work/mjarm/dev" --no-install fk 2>&1) || true
grep -q 'apt-get install .*libeigen3-dev' <<<"$answer" || fail "another library is not seen: $answer"

# Who may not install is told what an administrator runs.
printf '#!/bin/sh\nexit 1\n' >"$work/bin/sudo"
user=()
if ((EUID == 0)); then
  user=(setpriv --reuid=65534 --regid=65534 --clear-groups)
  chmod 755 "$work" && chmod 777 "$work/mjarm/.deps" && rm -f "$work/mjarm/.deps/lock"
fi
if "${user[@]}" true 2>/dev/null; then
  touch "$work/mjarm/mjarm/new.cpp"
  answer=$("${user[@]}" env PATH="$work/bin:$PATH" "$work/mjarm/dev" fk 2>&1) || true
  grep -q 'needs root.*apt-get install .*libeigen3-dev.* libosmesa6' <<<"$answer" || fail "without sudo: $answer"
fi
rm -f "$work/mjarm/.deps/lock"

# A folder that cannot be written.
mkdir "$work/mjarm/.deps/lock"
answer=$(PATH="$work/bin:$PATH" "$work/mjarm/dev" fk 2>&1) || true
grep -q 'mjarm cannot be written' <<<"$answer" || fail "read-only folder: $answer"
rmdir "$work/mjarm/.deps/lock"

cat >"$work/bin/dpkg-query" <<'END'
#!/bin/sh
shift 2
for name in "$@"; do echo "ii  $name"; done
END

# Benchmarks: configured anew where google-benchmark came since; none is no success.
printf '#!/bin/sh\nexit 0\n' | tee "$work/bin/ninja" >"$work/bin/python3"
printf '#!/bin/sh\ntouch %s/cmake-called\n' "$work" >"$work/bin/cmake"
chmod +x "$work/bin/"*
touch "$work/mjarm/build/release/build.ninja"
code=0
answer=$(PATH="$work/bin:$PATH" "$work/mjarm/dev" bench 2>&1) || code=$?
[[ $code == 1 && -e $work/cmake-called ]] || fail "bench: exit code $code: $answer"
grep -q 'no google-benchmark' <<<"$answer" || fail "bench: $answer"
rm "$work/cmake-called"
printf '#!/bin/sh\necho measured\n' >"$work/mjarm/build/release/bin/ik_bench"
chmod +x "$work/mjarm/build/release/bin/ik_bench"
answer=$(PATH="$work/bin:$PATH" "$work/mjarm/dev" bench 2>/dev/null) || fail "bench: exit code $?"
[[ $answer == measured && ! -e $work/cmake-called ]] || fail "bench again: $answer"

# A download that is not what it should be never arrives; a machine without network is told so.
cat >"$work/bin/python3" <<'END'
#!/bin/sh
case "$*" in *--version*) exit 0 ;; esac
[ -z "$NO_NETWORK" ] || exit 1
while [ "$1" != --dest ]; do shift; done
echo "something else" >"$2/mujoco_core-4.0.1-cp311.whl"
END
chmod +x "$work/bin/python3"
answer=$(PATH="$work/bin:$PATH" "$work/mjarm/dev" --no-install 2>&1) || fail "nothing is missing, but: $answer"
rmdir "$work/mjarm/.deps/mujoco-core-4.0.1"
code=0
answer=$(PATH="$work/bin:$PATH" "$work/mjarm/dev" fk 2>&1) || code=$?
[[ $code == 1 ]] || fail "wrong download: exit code $code: $answer"
grep -q 'SHA-256 differs' <<<"$answer" || fail "wrong download: $answer"
answer=$(PATH="$work/bin:$PATH" "$work/mjarm/dev" --no-install fk 2>&1) || true
[[ $answer == *"MuJoCo 4.0.1 is missing"* && $answer != *downloading* ]] || fail "--no-install without MuJoCo: $answer"
code=0
answer=$(NO_NETWORK=yes PATH="$work/bin:$PATH" "$work/mjarm/dev" fk 2>&1) || code=$?
[[ $code == 1 ]] || fail "no network: exit code $code: $answer"
grep -q 'package index reachable' <<<"$answer" || fail "no network: $answer"
left=$(find "$work/mjarm/.deps" -mindepth 1 ! -name lock)
[[ -z $left ]] || fail "left behind: $left"
