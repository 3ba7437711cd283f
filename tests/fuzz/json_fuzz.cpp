// Fuzzes what is read of JSON: requests for paths, cases of timing, planning problems and plans.
// What is taken is JSON to another reader as well.
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "mjarm/core/json.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/path/path_request.hpp"
#include "mjarm/planning/plan_file.hpp"
#include "mjarm/planning/problem_file.hpp"
#include "mjarm/trajectory/time_cases.hpp"
#include "tests/fuzz/finding.hpp"
#include "tests/support/temp_folder.hpp"

namespace {

using namespace mjarm;

const Arm& arm() {
  static const Arm arm = [] {
    auto robot = load_robot("ur5e");
    if (!robot) fuzz::finding("no robot", robot.error().what);
    return robot->arm;
  }();
  return arm;
}

void check_files(std::string_view input) {
  static const support::TempFolder folder;
  const std::string file = folder.write("in.json", std::string(input)).string();
  if (const auto problems = read_problem_file(file); !problems) {
    fuzz::check_refusal(problems.error());
  }
  if (const auto plans = read_plan_file(file, 2); !plans) fuzz::check_refusal(plans.error());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  const auto object = JsonObject::parse(input);
  check_files(input);
  if (!object) {
    fuzz::check_line(describe(object.error()));
    return 0;
  }
  if (!nlohmann::json::accept(input)) fuzz::finding("no JSON", std::string(input));
  if (const auto path = path_request_of(**object, arm()); !path) {
    fuzz::check_refusal(path.error());
  }
  for (const TimeProblem problem : kTimeProblems) {
    const auto cases = read_time_cases(std::string(input), problem);
    if (!cases) fuzz::check_refusal(cases.error());
  }
  return 0;
}
