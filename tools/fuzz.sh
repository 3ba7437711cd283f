# Part of ./dev: fuzzes the readers of files. Sourced, never run.

fuzzers=(load urdf program json safetensors sb3)

# write_fuzz_seeds NAME FOLDER: what a fuzzer starts from, beside what it found before.
write_fuzz_seeds() {
  local mutation=(python3 -B "$root/tests/mutation/mutation_test.py" --write-seeds "$2")
  case $1 in
    load) "$root/build/fuzz/bin/write_seeds" "$2" ;;
    urdf)
      "${mutation[@]}" --parser urdf
      "$root/build/fuzz/bin/write_seeds" "$2"
      ;;
    program) "${mutation[@]}" --parser program,config ;;
    json) "${mutation[@]}" --parser fk,ik,path,time,plan,verify ;;
    safetensors) cp "$root"/mjarm/rl/testdata/*.safetensors "$2" ;;
    sb3) cp "$root"/mjarm/rl/testdata/*.zip "$2" ;;
  esac
}

# run_fuzz [SECONDS] [NAME]: each of the fuzzers, or the one of that name. What is found lies under
# build/fuzz/found, one file an input; exit code 1 when there is any. Inputs that crashed MuJoCo and
# were turned into a line lie under build/fuzz/caught.
run_fuzz() {
  local seconds=${1:-600} chosen=${2:-} folder=$root/build/fuzz name found failed=0
  [[ $seconds =~ ^[0-9]+$ ]] || die "fuzz: \"$seconds\" is no whole number of seconds"
  [[ -z $chosen || " ${fuzzers[*]} " == *" $chosen "* ]] || die "fuzz: unknown name '$chosen' (${fuzzers[*]})"
  set_up_packages clang libclang-rt-dev
  build fuzz "${fuzzers[@]/%/_fuzz}" write_seeds
  unlock
  mkdir -p "$folder"/{found,caught}
  for name in ${chosen:-"${fuzzers[@]}"}; do
    mkdir -p "$folder"/{corpus,seeds}/"$name"
    write_fuzz_seeds "$name" "$folder/seeds/$name"
    step "Fuzzing $name for $seconds s" env MJARM_FUZZ_CAUGHT="$folder/caught" nice -n 19 \
      "$folder/bin/${name}_fuzz" -max_total_time="$seconds" -max_len=40000 -timeout=60 -rss_limit_mb=2048 \
      -print_final_stats=1 -verbosity=0 -artifact_prefix="$folder/found/$name-" \
      "$folder/corpus/$name" "$folder/seeds/$name" || failed=1
  done
  found=$(find "$folder/found" -type f | wc -l)
  say "caught and told: $(find "$folder/caught" -type f | wc -l); findings: $found"
  ((failed == 0 && found == 0))
}
