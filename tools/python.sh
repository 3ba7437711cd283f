# Part of ./dev: the package of Python. Sourced after setup.sh, never run.

# is_python PROGRAM LEAST BELOW: true for a Python of such a version, such as 3.11, with headers.
is_python() {
  "$1" - "$2" "$3" 2>/dev/null <<'END'
import ensurepip, pathlib, sys, sysconfig, venv
least, below = (tuple(map(int, word.split("."))) for word in sys.argv[1:])
headers = pathlib.Path(sysconfig.get_paths()["include"]) / "Python.h"
sys.exit(not (least <= sys.version_info[:2] < below and headers.is_file()))
END
}

# True where there is a Python that the package can be built for, with its headers; it goes into $python3.
find_python() {
  for python3 in ${python3:-} python3 /usr/bin/python3; do
    is_python "$python3" 3.11 4.0 && return
  done
  return 1
}

# A Python for each kind of wheel, as far as there is one: 3.11 has its own, all from 3.12 on have one together.
pythons_of_wheels() {
  local one range
  for range in "3.11 3.12" "3.12 4.0"; do
    for one in python3 /usr/bin/python3 python3.11 python3.12 python3.13 python3.14 \
      "${PYENV_ROOT:-$HOME/.pyenv}"/versions/3.*/bin/python3; do
      is_python "$one" $range && echo "$one" && break
    done
  done
}

# python_environment NAME: a folder in .deps with what python/requirements-NAME.txt pins, made where it is missing; it
# goes into $environment.
python_environment() {
  local list=$root/python/requirements-$1.txt mark
  mark=$("$python3" -c 'import sys; print("%d.%d" % sys.version_info[:2])')-$(sha256sum "$list" | cut -c1-12) || return
  environment=$deps/python-$1-$mark
  [[ -e $environment/whole ]] && return
  [[ $may_install == yes ]] || { say "the packages of ${list#"$root/"} are missing; ./dev without --no-install fetches them" && return 1; }
  rm -rf "$environment"
  step "Python: installing what it takes to $1 the package" install_environment "$environment" -r "$list"
}

install_environment() {
  local folder=$1
  shift
  "$python3" -m venv "$folder" &&
    quiet "$folder/bin/pip" install --disable-pip-version-check --require-hashes --only-binary=:all: "$@" &&
    touch "$folder/whole"
}

# The options with which cmake builds the module too, one a line; none where that cannot be.
python_options() {
  find_python && python_environment build || return 0
  printf '%s\n' -DMJARM_PYTHON=ON "-DPython_EXECUTABLE=$environment/bin/python"
}

# build_wheel PRESET FOLDER: the wheel of what the build folder of the preset holds. The pip of Debian 12, 23.0, does not know
# the short form of --config-settings.
build_wheel() {
  local build=$root/build/$1 target=$2 work
  find_python && python_environment build || return
  work=$(mktemp -d "$build/wheel.XXXXXX")
  quiet "$environment/bin/pip" wheel "$root/python" --no-deps --no-build-isolation --disable-pip-version-check \
    --config-settings cmake.define.MJARM_BUILD="$build" --config-settings build-dir="$work/cmake" --wheel-dir "$work" &&
    quiet "$environment/bin/python" -B "$root/tools/repair_wheel.py" "$work"/mjarm-*.whl "$target"
  local code=$?
  rm -rf "$work"
  return $code
}

# pack_wheels FOLDER: by a better compressor than Python's, which every pip can read. The bound shows what slips in unseen: the
# module with AprilTag and the libraries it needs make 13.3 MB.
pack_wheels() {
  set_up_packages advancecomp
  if command -v advzip >/dev/null; then quiet advzip --recompress --shrink-normal "$1"/*.whl || return; fi
  [[ -z $(find "$1" -name '*.whl' -size +16000000c) ]] || { say "larger than 16 MB: $(ls -s --block-size=1 "$1"/*.whl)" && return 1; }
}

# test_wheel FOLDER RESULTS: runs the tests of the wheel in there, where nothing else of mjarm is found, nor a compiler.
test_wheel() {
  local results=$2
  python_environment test || return
  quiet "$environment/bin/pip" install --disable-pip-version-check --no-deps --no-index --force-reinstall \
    --find-links "$1" mjarm || return
  rm -f "$results"
  (cd / && PATH=$environment/bin "$environment/bin/python" -B -m pytest -q -p no:cacheprovider -n "$(jobs_at_once)" --junitxml "$results" \
    "$root/python/tests" >&2) || true
  [[ -e $results ]]
}

# check_types: judges the types of the installed wheel, as an editor does that is set to be strict. The programs of the learning
# path, which the wheel holds in share, use mujoco, which has no types to judge.
check_types() {
  local tests site
  python_environment test && tests=$environment && python_environment check || return
  site=$("$tests/bin/python" -c 'import sysconfig; print(sysconfig.get_paths()["purelib"])')/mjarm
  "$environment/bin/basedpyright" --project "$root/python/tests/pyrightconfig.json" --pythonpath "$tests/bin/python" \
    "$site"/{*.py,*.pyi,data} "$root"/python/examples/*.py >&2
}

# check_abi FOLDER: the wheel for many versions of Python calls nothing that one of them lacks.
check_abi() {
  python_environment check && "$environment/bin/abi3audit" --strict "$1"/mjarm-*-abi3-*.whl >&2
}

# configure_wheel: the build folder of the wheel, for $python3.
configure_wheel() {
  python_environment build || return
  rm -f "$root"/build/wheel/python/mjarm/_core*
  quiet cmake -S "$root" --preset wheel -U 'Python_*' -U '_Python*' -U 'nanobind_*' \
    -DMUJOCO_ROOT="${MUJOCO_ROOT:-$mujoco/mujoco}" -DMJARM_PYTHON=ON -DPython_EXECUTABLE="$environment/bin/python" &&
    note_libraries wheel
}

# Data sets and the environment, judged by LeRobot itself, which takes a Python from 3.12 on. It is large, so no part of `./dev test`.
run_lerobot() {
  local build=$root/build/wheel results=$root/build/wheel/lerobot.xml
  for python3 in $(pythons_of_wheels) ""; do is_python "$python3" 3.12 4.0 && break; done
  [[ $python3 ]] || die "lerobot: it takes a Python of 3.12 or later, with headers"
  check "$("$python3" --version)" configure_wheel
  ((failed)) || check "build" build_counted wheel mjarm_python mjarm_python_stub
  ((failed)) || check "wheel" build_wheel wheel "$build/lerobot"
  ((failed)) || check "lerobot: installed" python_environment lerobot
  ((failed)) || check "tests" test_lerobot "$build/lerobot" "$results"
  [[ ! -e $results ]] || count_results "$results"
  finish
}

# test_lerobot FOLDER RESULTS: with the wheel in there.
test_lerobot() {
  python_environment lerobot || return
  quiet "$environment/bin/pip" install --disable-pip-version-check --no-deps --no-index --force-reinstall --find-links "$1" mjarm &&
    quiet "$environment/bin/pip" install --disable-pip-version-check --no-deps --no-build-isolation --force-reinstall \
      "$root/python/lerobot_env_mjarm" || return
  rm -rf "$2" "$root"/python/lerobot_env_mjarm/{build,*.egg-info}
  (cd / && PATH=$environment/bin:$PATH HF_HUB_OFFLINE=1 HF_HOME="$root/build/wheel/hf" "$environment/bin/python" -B -m pytest -q -p no:cacheprovider \
    --junitxml "$2" "$root/python/lerobot_env_mjarm/tests" >&2) || true
  [[ -e $2 ]]
}
