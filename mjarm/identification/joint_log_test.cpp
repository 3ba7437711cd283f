#include "mjarm/identification/joint_log.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <string>

#include "mjarm/model/robot.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using ::testing::HasSubstr;

/// Writes `text` to a file of its own and reads it as a log of the UR5e.
Result<JointLog> read_text(const std::string& text) {
  const support::TempFolder folder;
  const std::filesystem::path file = folder.path() / "log.csv";
  std::ofstream(file) << text;
  return read_joint_log(file, load_robot("ur5e").value().arm);
}

std::string head(const std::string& between = "") {
  const Arm arm = load_robot("ur5e").value().arm;
  std::string out = "time [s]";
  for (const ArmJoint& joint : arm.joints) out += ",torque " + joint.name + " [N m]";
  out += between;
  for (const ArmJoint& joint : arm.joints) out += ",q " + joint.name + " [rad]";
  return out + "\n";
}

TEST(JointLog, FindsColumnsByNameWhateverStandsBetween) {
  const JointLog log = read_text(head(",contacts") +
                                 "0.1,1,2,3,4,5,6,\"a|b;c|d\",.1,.2,.3,.4,.5,.6\n"
                                 "0.102,7,8,9,10,11,12,,1.1,1.2,1.3,1.4,1.5,1.6\n")
                           .value();
  EXPECT_NEAR(log.timestep, 0.002, 1e-15);
  ASSERT_EQ(log.q.size(), 2u);
  EXPECT_EQ(log.torque[0][5], 6);
  EXPECT_EQ(log.q[1][0], 1.1);
}

TEST(JointLog, TakesWhereAMotionEndsAndTheNextBeginsOnce) {
  const std::string row = ",1,2,3,4,5,6,.1,.2,.3,.4,.5,.6\n";
  const JointLog log =
      read_text(head() + "0" + row + "0.002" + row + "0.002" + row + "0.004" + row).value();
  EXPECT_EQ(log.q.size(), 3u);
  EXPECT_EQ(log.timestep, 0.002);
}

TEST(JointLog, SaysInOneLineWhatIsWrong) {
  const auto said = [](const std::string& text) { return read_text(text).error().what; };
  EXPECT_THAT(said("time [s],q shoulder_pan_joint\n"), HasSubstr("no column \"q shoulder_lift"));
  EXPECT_THAT(said(""), HasSubstr("no column \"time\""));
  const std::string row = ",1,2,3,4,5,6,.1,.2,.3,.4,.5,.6\n";
  EXPECT_THAT(said(head() + "0" + row + "0.002,1\n"), HasSubstr("log.csv:3: 2 fields"));
  EXPECT_THAT(said(head() + "0,x,2,3,4,5,6,.1,.2,.3,.4,.5,.6\n"),
              HasSubstr("log.csv:2: column \"torque shoulder_pan_joint [N m]\": \"x\""));
  EXPECT_THAT(said(head() + "0" + row + "0.002" + row + "0.005" + row), HasSubstr("log.csv:4:"));
  EXPECT_THAT(said(head() + "0" + row + "0" + row), HasSubstr("log.csv:3:"));
  EXPECT_THAT(said(head() + "0" + row + "0.002" + row + "0" + row), HasSubstr("log.csv:4:"));
  const std::string other = ",1,2,3,4,5,6,.1,.2,.3,.4,.5,.7\n";
  EXPECT_THAT(said(head() + "0" + row + "0.002" + row + "0.002" + other), HasSubstr("log.csv:4:"));
}

}  // namespace
}  // namespace mjarm
