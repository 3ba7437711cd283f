# Part of ./dev: fuzzes the loader of models. Sourced, never run.

# run_fuzz [SECONDS]: what is found lies under build/fuzz/found, one file an input; exit code 1 when
# there is any. Inputs that crashed MuJoCo and were turned into a line lie under build/fuzz/caught.
run_fuzz() {
  local seconds=${1:-600} folder=$root/build/fuzz
  [[ $seconds =~ ^[0-9]+$ ]] || die "fuzz: \"$seconds\" is no whole number of seconds"
  set_up_packages clang libclang-rt-dev
  build fuzz load_fuzz write_seeds
  unlock
  mkdir -p "$folder"/{corpus,seeds,found,caught}
  "$folder/bin/write_seeds" "$folder/seeds"
  step "Fuzzing for $seconds s" env MJARM_FUZZ_CAUGHT="$folder/caught" nice -n 19 \
    "$folder/bin/load_fuzz" -max_total_time="$seconds" -max_len=20000 -timeout=60 -rss_limit_mb=2048 \
    -print_final_stats=1 -verbosity=0 -artifact_prefix="$folder/found/" "$folder/corpus" "$folder/seeds"
  say "caught and told: $(find "$folder/caught" -type f | wc -l); findings: $(find "$folder/found" -type f | wc -l)"
}
