# Part of ./dev: the site, and the pages as they run. Sourced after test.sh and python.sh, never run.

site_packages="python3-sphinx python3-myst-parser furo"

# The Python that has Sphinx with what the site takes: the system's own, else the first in PATH.
find_sphinx() {
  for python3 in /usr/bin/python3 python3; do
    "$python3" -c 'import furo, myst_parser, sphinx' 2>/dev/null && return
  done
  die "docs: no Python with sphinx, myst_parser and furo; Debian and Ubuntu: apt-get install $site_packages"
}

# run_docs [--run [PAGE...]]: the site into build/docs; with --run, what the pages say is run instead, that of all pages or of some.
run_docs() {
  case ${1:-} in
    "") build_site ;;
    --run) run_pages "${@:2}" ;;
    *) die "docs: unknown option '$1'; ./dev docs, or ./dev docs --run [PAGE...]" ;;
  esac
}

build_site() {
  set_up_packages $site_packages
  find_sphinx
  check "links" check_links
  check "build" build_counted release mjarm mjarm-bench
  ((failed)) || check "site" "$python3" -B "$root/tools/site/build.py" --program "$release/bin/mjarm" --out "$root/build/docs"
  ((failed)) || say "open build/docs/index.html in a browser"
  finish
}

run_pages() {
  local pages=("$@") readme=() others=() page
  if ((${#pages[@]} == 0)); then pages=("$root"/README*.md "$root"/docs/*.md "$root"/docs/learn/*.md "$root"/python/README*.md); fi
  for page in "${pages[@]}"; do
    case $page in
      *docs/learn/\*.md) ;;
      "$root"/README*.md | README*.md) readme+=("$page") ;;
      *) others+=("$page") ;;
    esac
  done
  find_python || die "docs: no Python 3.11 with headers and venv"
  check "build" build_counted dev all
  ((failed)) || check "wheel" build_wheel dev "$root/build/dev/wheel.pages"
  ((failed)) || check "wheel: installed" install_for_pages
  if ((failed == 0)); then
    ((${#readme[@]} == 0)) || count_pages --tables "${readme[@]}"
    ((${#others[@]} == 0)) || count_pages "${others[@]}"
  fi
  finish
}

install_for_pages() {
  python_environment pages &&
    quiet "$environment/bin/pip" install --disable-pip-version-check --no-deps --no-index --force-reinstall \
      --find-links "$root/build/dev/wheel.pages" mjarm
}

# count_pages OPTION|PAGE...: runs them and adds to the counts.
count_pages() {
  local lines
  say "check: pages ..."
  lines=$(python3 -B "$root/tools/check_pages.py" --program "$root/build/dev/bin/mjarm" --python "$environment/bin/python" \
    --seconds 300 "$@" | tee >(cat >&2)) || true
  if [[ $(tail -n 1 <<<"$lines") =~ ^([0-9]+)\ passed,\ ([0-9]+)\ failed,\ ([0-9]+)\ skipped$ ]]; then
    passed=$((passed + BASH_REMATCH[1])) failed=$((failed + BASH_REMATCH[2])) skipped=$((skipped + BASH_REMATCH[3]))
  else
    failed=$((failed + 1))
  fi
}
