// Fuzzes URDF as users meet it: any bytes give a robot whose tool is somewhere, or one line.
#include <cstdint>
#include <string>

#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/robot.hpp"
#include "tests/fuzz/finding.hpp"
#include "tests/support/temp_folder.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mjarm;
  static const support::TempFolder folder;
  const auto file = folder.write("a.urdf", std::string(reinterpret_cast<const char*>(data), size));
  const auto robot = load_robot(file.string());
  if (!robot) {
    fuzz::check_line(robot.error().what);
    if (!is_utf8(robot.error().what)) fuzz::finding("no UTF-8", robot.error().what);
    return 0;
  }
  const Pose X_WT = fk(robot->arm, as_span(robot->arm.home));
  if (!X_WT.p.allFinite() || !X_WT.R.allFinite()) fuzz::finding("a tool nowhere", file.string());
  return 0;
}
