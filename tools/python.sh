# Part of ./dev: the package of Python. Sourced after setup.sh, never run.

# True where there is a Python that the package can be built for, with its headers; it goes into $python3.
find_python() {
  for python3 in python3 /usr/bin/python3; do
    "$python3" - 2>/dev/null <<'END' && return
import ensurepip, pathlib, sys, sysconfig, venv
sys.exit(sys.version_info < (3, 11) or not (pathlib.Path(sysconfig.get_paths()["include"]) / "Python.h").is_file())
END
  done
  return 1
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

# build_wheel PRESET FOLDER: the wheel of what the build folder of the preset holds.
build_wheel() {
  local build=$root/build/$1 target=$2 work
  find_python && python_environment build || return
  work=$(mktemp -d "$build/wheel.XXXXXX")
  quiet "$environment/bin/pip" wheel "$root/python" --no-deps --no-build-isolation --disable-pip-version-check \
    -C cmake.define.MJARM_BUILD="$build" -C build-dir="$work/cmake" --wheel-dir "$work" &&
    rm -rf "$target" &&
    quiet "$environment/bin/python" -B "$root/tools/repair_wheel.py" "$work"/mjarm-*.whl "$target"
  local code=$?
  rm -rf "$work"
  return $code
}

# test_wheel FOLDER RESULTS: runs the tests of the wheel in there, where nothing else of mjarm is found, nor a compiler.
test_wheel() {
  local results=$2
  python_environment test || return
  quiet "$environment/bin/pip" install --disable-pip-version-check --no-deps --no-index --force-reinstall \
    "$1"/mjarm-*.whl || return
  rm -f "$results"
  (cd / && PATH=$environment/bin "$environment/bin/python" -B -m pytest -q -p no:cacheprovider --junitxml "$results" \
    "$root/python/tests" >&2) || true
  [[ -e $results ]]
}
