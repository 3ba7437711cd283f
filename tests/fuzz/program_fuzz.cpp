// Fuzzes what is read of YAML: motion programs and configurations of trainings. Any bytes give a
// program or faults, each one line with a place in the text.
#include <cstdint>
#include <string>

#include "mjarm/program/program_reader.hpp"
#include "mjarm/rl/training_config.hpp"
#include "tests/fuzz/finding.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mjarm;
  const std::string input(reinterpret_cast<const char*>(data), size);
  const program::ProgramText read = program::look_through(input);
  for (const program::TextFault& fault : read.faults) {
    fuzz::check_line(fault.what);
    if (fault.place.line < 0) fuzz::finding("a place that is none", fault.what);
  }
  const auto parsed = program::parse_program(input, "p.yaml");
  if (parsed.has_value() != read.faults.empty()) fuzz::finding("two minds", input);
  if (!parsed) fuzz::check_refusal(parsed.error());

  const auto config = rl::read_config(input, "c.yaml");
  if (!config) {
    fuzz::check_refusal(config.error());
    return 0;
  }
  const std::string written = rl::config_text(*config);
  const auto again = rl::read_config(written, "c.yaml");
  if (!again) fuzz::finding("what it wrote is refused", again.error().what);
  if (rl::config_text(*again) != written) fuzz::finding("it reads something else", written);
  return 0;
}
