#include <string>
#include <vector>

#include "apps/bench/suites.hpp"
#include "apps/mjarm/cli/cli.hpp"
#include "mjarm/core/os_streams.hpp"

/// `mjarm-bench ik ...` and `mjarm bench ik ...`, which hands its own arguments over, are the same.
int main(int argc, char** argv) {
  mjarm::open_standard_streams();
  std::vector<std::string> arguments(argv + (argc > 0), argv + argc);
  const std::size_t word = mjarm::app::command_word(arguments);
  if (word == arguments.size() || arguments[word] != "bench") {
    arguments.insert(arguments.begin(), "bench");
  }
  const mjarm::app::Command commands[] = {mjarm::app::bench_command()};
  return mjarm::app::run(commands, arguments);
}
