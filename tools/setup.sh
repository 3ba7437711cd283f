# Part of ./dev: brings the machine to where mjarm can be built. Sourced, never run.

# What a run needs, and what the tests need besides. Plots and windows need a Chinese font for
# `--lang zh-CN`: fonts-wqy-microhei is the smallest (1.6 MB to fetch, fonts-noto-cjk 57) and depends
# on nothing. Optional ones: not every release has them, and nothing asks for them alone.
run_packages="g++ cmake ninja-build pkgconf python3-pip unzip libeigen3-dev libexpected-dev
  libfmt-dev libspdlog-dev libboost-dev nlohmann-json3-dev libyaml-cpp-dev libtinyxml2-dev libcli11-dev
  libpng-dev libcairo2-dev libfontconfig-dev libglfw3-dev libegl-dev libgl-dev libopengl-dev
  libgl1-mesa-dri ca-certificates libcurl4-openssl-dev libssl-dev zlib1g-dev fonts-dejavu-core
  fonts-wqy-microhei"
test_packages="libgtest-dev libgmock-dev libbenchmark-dev ccache xvfb xauth xdotool ffmpeg
  libopenmpi-dev openmpi-bin python3-dev python3-venv"
optional_packages="libosmesa6"
optional_test_packages="libompl-dev libapriltag-dev"

# One process at a time sets up or builds in this folder.
lock() {
  { mkdir -p "$deps" && : >>"$deps/lock"; } 2>/dev/null || die "$(words read_only "$root")"
  exec 9>"$deps/lock"
  flock -n 9 && return
  say "$(words waiting)"
  flock 9
}
unlock() { exec 9>&-; }

# step TEXT COMMAND...: says what is done, and when it is done, how long it took.
step() {
  local text=$1 from=$SECONDS
  shift
  say "$(words begins "$text")"
  "$@" || return
  say "$(words finished "$text" $((SECONDS - from)))"
}

# quiet COMMAND...: its output is shown only when it fails.
quiet() {
  local log
  log=$(mktemp)
  if "$@" >"$log" 2>&1; then
    rm -f "$log"
    return
  fi
  tail -n 25 "$log" >&2
  rm -f "$log"
  return 1
}

silent() { "$@" &>/dev/null; }

# missing PACKAGE...: those that are not installed.
missing() {
  local installed name
  installed=$(dpkg-query -W -f='${db:Status-Abbrev} ${Package}\n' "$@" 2>/dev/null |
    sed -n 's/^.i  *//p') || true
  for name in "$@"; do
    grep -qxF -- "$name" <<<"$installed" || echo "$name"
  done
}

as_root() {
  if ((EUID == 0)); then
    DEBIAN_FRONTEND=noninteractive "$@"
  else
    sudo env DEBIAN_FRONTEND=noninteractive "$@"
  fi
}

apt_install() {
  as_root apt-get install -y -qq --no-install-recommends "$@"
}

# Fails where a list cannot be fetched, which apt-get takes for a warning.
apt_update() {
  step "$(words apt_update)" quiet as_root apt-get update -qq -o APT::Update::Error-Mode=any
}

# How many MB apt-get would fetch to install PACKAGE...
megabytes_of() {
  apt-get install -y -qq --no-install-recommends --print-uris "$@" 2>/dev/null |
    awk '{bytes += $3} END {print int(bytes / 1e6 + 0.5)}'
}

# The ones of PACKAGE... that apt knows a version of.
available() {
  apt-cache policy "$@" 2>/dev/null | awk '/^[^ ].*:$/ {name = substr($1, 1, length($1) - 1)}
    /^  Candidate:/ && $2 != "(none)" {print name}'
}

# with_optional PACKAGE...: these, and the optional ones that this release has.
with_optional() {
  local optional
  mapfile -t optional < <(missing $optional_packages)
  printf '%s\n' "$@"
  ((${#optional[@]} == 0)) || available "${optional[@]}"
}

# The command that installs PACKAGE..., for somebody who may.
install_line() {
  echo "apt-get install --no-install-recommends" $(with_optional "$@")
}

install_packages() {
  local wanted
  ((EUID == 0)) || { command -v sudo >/dev/null && sudo true; } || die "$(words needs_root "$(install_line "$@")")"
  (($(available "$@" | wc -l) == $#)) || apt_update || say "$(words no_update)"
  mapfile -t wanted < <(with_optional "$@")
  step "$(words apt_install ${#wanted[@]} "$(megabytes_of "${wanted[@]}")")" silent apt_install "${wanted[@]}" && return
  # The lists may be old; one that is out of reach may be somebody else's.
  apt_update || { silent apt_install "${wanted[@]}" && return; } || die "$(words no_update)"
  step "$(words apt_again)" quiet apt_install "${wanted[@]}" || die "$(words no_install "$*")"
}

# set_up_packages run|test|NAME...
set_up_packages() {
  local wanted program
  if ! command -v dpkg-query >/dev/null; then
    say "$(words no_dpkg "$*")"
    for program in cmake ninja c++; do command -v "$program" >/dev/null || die "$(words no_program "$program")"; done
    return
  fi
  mapfile -t wanted < <(missing "$@")
  ((${#wanted[@]})) || return 0
  say "$(words missing "${wanted[*]}")"
  [[ $may_install == yes ]] || die "$(words install_line "$(install_line "${wanted[@]}")")"
  install_packages "${wanted[@]}"
}

# A python3 that has pip: the first in PATH, else the system's own.
python_with_pip() {
  local python
  for python in python3 /usr/bin/python3; do
    if "$python" -m pip --version >/dev/null 2>&1; then
      echo "$python"
      return
    fi
  done
  die "$(words no_pip)"
}

# fetch_wheel NAME VERSION SHA256 MEMBERS PIP_ARGS...: downloads one wheel, checks its hash, and
# unpacks those members to .deps/NAME-VERSION; the folder appears only when it is whole.
fetch_wheel() {
  local name=$1 version=$2 hash=$3 members=$4 python work wheel
  shift 4
  [[ -e $deps/$name-$version ]] && return
  [[ $may_install == yes ]] || die "$(words not_fetched "$name $version")"
  python=$(python_with_pip) || exit
  work=$(mktemp -d "$deps/fetch.XXXXXX")
  if ! quiet "$python" -m pip download --disable-pip-version-check --no-deps \
    --only-binary=:all: "$@" --dest "$work" "$name==$version"; then
    rm -rf "$work"
    say "$(words no_download "$name $version")"
    return 1
  fi
  wheel=$(echo "$work"/*.whl)
  if ! sha256sum --status -c <<<"$hash  $wheel"; then
    rm -rf "$work"
    say "$(words other_file "$name $version")"
    return 1
  fi
  (set -f && unzip -q "$wheel" $members -d "$work") || die "$(words not_unpacked "$name $version")"
  rm "$wheel"
  chmod 755 "$work"
  mv -T "$work" "$deps/$name-$version"
}

# by_machine X86_64 AARCH64: the one of this machine.
by_machine() {
  case $(uname -m) in
    x86_64) echo "$1" ;;
    aarch64 | arm64) echo "$2" ;;
    *) die "$(words other_machine "$(uname -m)")" ;;
  esac
}

# The library does not depend on Python, but there is a wheel per Python version: always take cp311.
fetch_mujoco() {
  local hash platform
  hash=$(by_machine be28c0c7587347ef996b4de0487264e9da296282082b092bae211a9163e9aed6 \
    52d934614a56f7d75dcfc2bd8bb72f058b465ecc19a0583a56df242f9505bdb6) || exit
  platform=$(by_machine manylinux_2_28_x86_64 manylinux_2_28_aarch64)
  fetch_wheel mujoco-core 4.0.1 "$hash" \
    "mujoco/libmujoco.so.* mujoco/include/* mujoco_core-*/licenses/*" \
    --python-version 311 --implementation cp --abi cp311 --platform "$platform"
}

# Prints the path of the pinned clang-format or clang-tidy, after fetching it where needed.
clang_tool() {
  local tool=$1 hash version platform
  case $tool in
    clang-format)
      version=20.1.8 platform=manylinux_2_28
      hash=$(by_machine 7c6bcb7e01ba4f05a4c980fda147b330f7e4833c2aea8c92a0c2df9573ae7afe \
        34de32fe53452a07497793d5faf3fd03f7cf8b960b915417471ae81227461a39) || exit
      ;;
    clang-tidy)
      version=20.1.0 platform=manylinux2014
      hash=$(by_machine e205541e350044ffe0b0d1fcaf62b9953890f8ecba31458bbcdcfe73040e58b6 \
        14125fd35b2d324da33c884ab8b5a1d9d70a5a2e76f071ca14783d325a992917) || exit
      ;;
  esac
  fetch_wheel "$tool" "$version" "$hash" "${tool/-/_}/*" --platform "${platform}_$(uname -m)" ||
    return
  echo "$deps/$tool-$version/${tool/-/_}/data/bin/$tool"
}

# set_up_machine run|test: packages and MuJoCo. Does nothing where all is there.
set_up_machine() {
  local packages=$run_packages
  if [[ $1 == test ]]; then
    packages="$packages $test_packages"
    optional_packages="$optional_packages $optional_test_packages"
  fi
  set_up_packages $packages
  if [[ -z ${MUJOCO_ROOT:-} && ! -e $mujoco ]]; then
    [[ $may_install == yes ]] || die "$(words not_fetched "MuJoCo 4.0.1")"
    step "$(words fetching "MuJoCo 4.0.1")" fetch_mujoco || exit
  fi
}

# True where a plain `cmake --preset dev` configured the folder without the module of Python, which its tests want.
lacks_python() {
  [[ $1 == dev ]] && grep -qxF "MJARM_PYTHON:BOOL=OFF" "$root/build/$1/CMakeCache.txt" && [[ $(python_options) ]]
}

# Keeps in mind what build/PRESET was configured with.
note_libraries() { optional_libraries >"$root/build/$1/.dev-libraries"; }

# configure PRESET: where that was not done, or with other libraries.
configure() {
  local preset=$1 folder=$root/build/$1 options=()
  if [[ ! -e $folder/build.ninja ]] || lacks_python "$preset" || other_libraries "$preset" ||
    { [[ -n ${MUJOCO_ROOT:-} ]] && ! uses_mujoco_root "$preset"; }; then
    [[ $preset != dev && $preset != wheel ]] || mapfile -t options < <(python_options)
    step "$(words configuring "$preset")" quiet cmake -S "$root" --preset "$preset" \
      -DMUJOCO_ROOT="${MUJOCO_ROOT:-$mujoco/mujoco}" "${options[@]}" ||
      die "$(words not_configured "$preset")"
    note_libraries "$preset"
  fi
}

# build PRESET TARGET...
build() {
  local preset=$1
  shift
  configure "$preset"
  step "$(words building "$preset")" compile "$root/build/$preset" "$@" || die "$(words not_built "$preset")"
}

# Ninja's own lines go to stderr, so that stdout holds only results; off a terminal it is quiet.
compile() {
  local folder=$1 talk=()
  shift
  [[ -t 2 ]] || talk=(--quiet)
  NINJA_STATUS="  [%f/%t, %es] " ninja -C "$folder" -j "$(jobs_at_once)" "${talk[@]}" "$@" >&2
}

# A job needs about 1 GB, so memory bounds them as well as processors.
jobs_at_once() {
  local cores memory
  cores=$(nproc)
  memory=$(awk '/^MemAvailable/ {print int($2 / 1000000)}' /proc/meminfo)
  echo $((memory < 1 ? 1 : memory < cores ? memory : cores))
}
