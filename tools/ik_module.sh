# Part of ./dev: the kinematics of the page, web/dist/ik.wasm. Sourced after page.sh, never run.

# Prints why the module cannot be built here; nothing where it can.
ik_module_lacks() {
  command -v em++ >/dev/null || { words no_emscripten && return; }
  [[ -d /usr/include/eigen3 && -e /usr/include/tl/expected.hpp && -e /usr/include/fmt/format.h ]] ||
    words no_headers
}

# web/dist/ik.wasm, where emscripten is there; else says once for each time the page is built what that means.
build_ik_module() {
  local built=$root/build/ik_module why
  why=$(ik_module_lacks)
  if [[ $why ]]; then
    [[ $built/said -nt $root/web/dist/index.html ]] || say "$(words no_page_kinematics "$why")"
    { mkdir -p "$built" && : >"$built/said"; } 2>/dev/null || true
    return
  fi
  mkdir -p "$built" "$root/web/dist"
  if [[ $(ninja -C "$built" -f "$root/web/ik/build.ninja" -n 2>&1) != *"no work to do"* ]]; then
    step "$(words page_kinematics)" \
      quiet ninja -C "$built" -f "$root/web/ik/build.ninja" -j "$(jobs_at_once)" || return
  fi
  cmp -s "$built/ik.wasm" "$root/web/dist/ik.wasm" || cp "$built/ik.wasm" "$root/web/dist/ik.wasm"
}

# The page, which empties web/dist where it is built, then what it solves kinematics with.
build_whole_page() { build_page && build_ik_module; }

# check_ik_module PRESET: it answers as that build does. Answers near singularities hang on the last
# bit, so the program is asked without wide registers, which round otherwise.
check_ik_module() {
  local build=$root/build/$1 why
  why=$(ik_module_lacks)
  [[ -z $why ]] || { say "$why" && return 77; }
  find_node || return 77
  build_ik_module || return
  MJARM_SIMD=baseline "$build/bin/ik_module_cases" "$build/ik_module_cases.json" &&
    "$node" "$root/tests/ik_module/compare.mjs" "$root/web/dist/ik.wasm" "$build/ik_module_cases.json"
}
