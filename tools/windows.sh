# Part of ./dev: mjarm for Windows, built here by MinGW-w64 and tried under Wine. Sourced after test.sh, never run.

windows_build=$root/build/windows

# build_windows TARGET...: with the MuJoCo of Windows, whatever the environment names.
build_windows() {
  local MUJOCO_ROOT="" mujoco=$windows_mujoco
  build windows "$@"
}

# A zip that is unpacked and run: program, MuJoCo, models, page.
make_zip() {
  build_page || say "the zip goes without the page"
  (build_windows mjarm) || return
  rm -f "$root"/dist/mjarm-*-windows-*.zip
  quiet cpack --config "$windows_build/CPackConfig.cmake" && ls -l "$root"/dist/mjarm-*-windows-*.zip >&2
}

# Wine with a prefix of its own; quiet, and with nothing that asks for Mono or a browser, or waits in a debugger.
in_wine() {
  WINEPREFIX=$wine_home WINEDEBUG=-all WINEDLLOVERRIDES="mscoree,mshtml,winemenubuilder.exe,winedbg.exe=" LC_ALL=C.UTF-8 \
    timeout "${patience:-300}" /usr/lib/wine/wine64 "$@"
}

# windows_mjarm ARGS..., linux_mjarm ARGS...: the program of the zip and ours, each in a folder of its own.
windows_mjarm() { (cd "$tried/windows 试" && in_wine "$unpacked/bin/mjarm.exe" "$@"); }
linux_mjarm() { (cd "$tried/linux 试" && "$release/bin/mjarm" "$@"); }

# One server for all programs: each would start its own otherwise.
start_wine() {
  wine_home=$tried/wine
  mkdir -p "$wine_home"
  WINEPREFIX=$wine_home wineserver -p600
  quiet in_wine wineboot -i
  # A font that has Chinese characters, as every Windows has one.
  cp /usr/share/fonts/truetype/wqy/wqy-microhei.ttc "$wine_home/drive_c/windows/Fonts/" 2>/dev/null || true
}
stop_wine() { WINEPREFIX=$wine_home wineserver -k || true; }

same_numbers() { python3 -B "$root/tools/compare_numbers.py" "$tried/linux 试/$1" "$tried/windows 试/$1" "${@:2}"; }

# same_answer NAME ARGS...: what both print; equal to 1e-9.
same_answer() {
  local name=$1 code=0 other=0
  shift
  linux_mjarm "$@" >"$tried/linux 试/$name" 2>&1 || code=$?
  windows_mjarm "$@" >"$tried/windows 试/$name" 2>&1 || other=$?
  ((code == other)) || { say "exit code $code, and $other on Windows" && tail -n 3 "$tried/windows 试/$name" && return 1; }
  same_numbers "$name" --ignore "times real time" --ignore "实时"
}

# same_run ARGS...: what both write for a motion.
same_run() {
  linux_mjarm "$@" --headless --out "结果 1" >/dev/null 2>&1
  windows_mjarm "$@" --headless --out "结果 1" >/dev/null &&
    same_numbers "结果 1/log.csv" && same_numbers "结果 1/report.json" --ignore '"rtf"' &&
    [[ -s "$tried/windows 试/结果 1/picture.png" && -s "$tried/windows 试/结果 1/plot.png" ]]
}

chinese_help() { windows_mjarm --lang zh --help | grep -q "机械臂\|命令"; }

opens_a_window() { windows_mjarm view ur5e --seconds 3; }

# A model of somebody is tried out in a process of its own: one that makes MuJoCo hang or crash ends that one alone.
unknown_model() {
  mkdir -p "$tried/windows 试/我的 机器人" "$tried/linux 试/我的 机器人"
  cat >"$tried/windows 试/我的 机器人/手臂.xml" <<'XML'
<mujoco>
  <worldbody>
    <body name="link1">
      <joint name="j1" axis="0 0 1" range="-3 3" limited="true"/>
      <geom type="capsule" size=".04" fromto="0 0 .1 .3 0 .1" mass="1"/>
      <body name="link2" pos=".3 0 .1">
        <joint name="j2" axis="0 1 0" range="-3 3" limited="true"/>
        <geom type="capsule" size=".03" fromto="0 0 0 .3 0 0" mass="1"/>
        <site name="tip" pos=".3 0 0"/>
      </body>
    </body>
  </worldbody>
  <actuator>
    <motor joint="j1"/>
    <motor joint="j2"/>
  </actuator>
</mujoco>
XML
  cp "$tried/windows 试/我的 机器人/手臂.xml" "$tried/linux 试/我的 机器人/"
  same_answer fk.txt fk --robot "我的 机器人/手臂.xml" --q 0.3,0.4
}

# The zip, unpacked where a user may well put it.
unpack_zip() {
  tried=$(mktemp -d "$root/build/wine.XXXXXX")
  unpacked="$tried/程序 files"
  mkdir -p "$unpacked" "$tried/windows 试" "$tried/linux 试"
  unzip -q "$root"/dist/mjarm-*-windows-*.zip -d "$tried" && mv -T "$tried"/mjarm-*/ "$unpacked"
}

# The tests of rooms that open no window; perception and episode draw into a hidden one.
room_tests() {
  local room=$1
  (build_windows mjarm "${room}_test") &&
    MJARM_CACHE=off patience=900 in_wine "$windows_build/bin/${room}_test.exe" --gtest_brief=1
}

try_windows() {
  local room
  set_up_packages wine wine64 xvfb unzip
  up_to_date mjarm || (build release mjarm)
  unpack_zip || { check "zip: unpacked" false && return; }
  start_display
  start_wine
  check "wine: version" windows_mjarm --version
  check "wine: help in Chinese" chinese_help
  check "wine: ik" same_answer ik.txt ik --robot ur5e --pos -0.13,0.6,0.1 --euler 180deg,0,90deg --all --no-timing
  check "wine: check" same_answer check.txt check ellipse --json
  check "wine: plan" same_answer plan.txt plan --robot universal_robots_ur5e/wall.xml --pos -0.3,-0.45,0.2 \
    --euler 180deg,0,0 --no-timing
  check "wine: demo ellipse" same_run demo ellipse
  check "wine: run" same_run run table
  check "wine: model of somebody, Chinese path" unknown_model
  check "wine: a window" opens_a_window
  for room in core model kinematics collision path planning trajectory control identification sim execution program \
    perception rl episode teleop clone; do
    check "wine: tests of $room" room_tests "$room"
  done
  stop_wine
  rm -rf "$tried"
}

# run_windows [--test]
run_windows() {
  [[ ${1:-} == "" || $1 == --test ]] || die "windows: --test or nothing, not '$1'"
  set_up_windows
  check "windows: zip made" make_zip
  ((failed)) || [[ ${1:-} != --test ]] || try_windows
  finish
}
