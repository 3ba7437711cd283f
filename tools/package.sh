# Part of ./dev: the packages. Sourced after test.sh, never run.

# The packages of the release build, into dist/.
make_packages() {
  set_up_packages dpkg-dev file
  build_page || say "the packages go without the page"
  (build release all) && rm -f "$root"/dist/mjarm*.{deb,tar.gz} && quiet cpack --config "$root/build/release/CPackConfig.cmake" &&
    ls -l "$root"/dist/mjarm*.{deb,tar.gz} >&2
}

# in_bare COMMAND...: in the bare system, with nothing of this one; programs find themselves by /proc.
in_bare() {
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/try LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    unshare --mount --pid --fork --root="$bare" --mount-proc "$@"
}

# How a new user meets the package: a system with nothing in it, one line to install, the first picture, one line to be rid of it.
use_packages() {
  local left
  quiet debootstrap --variant=minbase "$(. /etc/os-release && echo "$VERSION_CODENAME")" "$bare" \
    "$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' | sed q)" || return
  cp /etc/apt/apt.conf.d/* "$bare/etc/apt/apt.conf.d/"  # how this machine reaches its packages
  mkdir "$bare/try"
  cp "$root"/dist/mjarm*.deb "$root"/dist/mjarm*.tar.gz "$bare/try/"
  quiet in_bare sh -c 'apt-get install -y --no-install-recommends /try/mjarm*.deb' || return
  in_bare mjarm --version >&2 && quiet in_bare mjarm demo ellipse --headless --out /try/out &&
    [[ -s $bare/try/out/picture.png ]] || return
  # The libraries it needs stay, so the tarball runs as well.
  quiet in_bare sh -c 'cd /try && tar xzf mjarm*.tar.gz && dpkg --purge mjarm && mjarm-*/bin/mjarm ik --robot ur5e --pos -0.13,0.6,0.1 --euler 180deg,0,90deg' || return
  left=$(find "$bare" -xdev -path "$bare/try" -prune -o \( -name '*mjarm*' -o -name 'libmujoco*' \) -print)
  [[ -z $left ]] || { say "left behind: $left" && return 1; }
}

try_packages() {
  local bare code=0
  ((EUID == 0)) && command -v debootstrap >/dev/null ||
    { say "trying the packages needs root and debootstrap" && return 77; }
  bare=$(mktemp -d)
  use_packages || code=$?
  rm -rf --one-file-system "$bare"
  return "$code"
}

run_package() {
  check "packages: made" make_packages
  ((failed)) || check "packages: installed, used and removed on a bare system" try_packages
  finish
}
