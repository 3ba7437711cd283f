#include "mjarm/sim/ctrl_schedule.hpp"

#include <gmock/gmock.h>
#include <mujoco/mujoco.h>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/sim/state_columns.hpp"
#include "mjarm/sim/worlds_test.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kDriven = R"(<mujoco>
  <worldbody>
    <body><freejoint name="car"/><geom size="0.1"/>
      <body><joint name="left" axis="0 1 0"/><geom size="0.1" pos="0 1 0"/></body>
      <body><joint name="lift" type="slide"/><geom size="0.1" pos="0 2 0"/></body>
      <body name="hand"><joint type="ball"/><geom size="0.1" pos="0 3 0"/></body>
    </body>
  </worldbody>
  <actuator>
    <motor name="left" joint="left" ctrllimited="true" ctrlrange="-1 1"/>
    <position name="lift" joint="lift" kp="50"/>
    <position name="geared" joint="left" kp="50" gear="2"/>
    <motor joint="left"/>
  </actuator>
  <sensor><framepos name="where" objtype="body" objname="world"/></sensor>
</mujoco>)";

std::vector<std::string> names_of(const std::vector<StateColumn>& columns) {
  std::vector<std::string> all;
  for (const StateColumn& column : columns) all.push_back(column.name + "|" + column.unit);
  return all;
}

class Schedule : public ::testing::Test {
 protected:
  LanguageScope english_{Language::english};
  Model model_ = Model::from_mjcf(kDriven).value();
  support::TempFolder folder_;

  Result<CtrlSchedule> read(const std::string& table) {
    return CtrlSchedule::read_csv(model_, folder_.write("c.csv", table));
  }
  [[nodiscard]] std::vector<double> at(const CtrlSchedule& schedule, double time) const {
    std::vector<double> ctrl(4, 9.0);
    schedule.apply(time, ctrl);
    return ctrl;
  }
};

TEST_F(Schedule, ColumnsAreInMujocosOrderWithTheirUnits) {
  const StateColumns columns = state_columns(model_);
  EXPECT_EQ(columns.qpos.size(), static_cast<std::size_t>(model_.nq()));
  EXPECT_EQ(columns.qvel.size(), static_cast<std::size_t>(model_.nv()));
  EXPECT_THAT(
      names_of(columns.qpos),
      ElementsAre("car x|m", "car y|m", "car z|m", "car qw|", "car qx|", "car qy|", "car qz|",
                  "left|rad", "lift|m", "hand qw|", "hand qx|", "hand qy|", "hand qz|"));
  EXPECT_THAT(names_of(columns.qvel),
              ElementsAre("car x|m/s", "car y|m/s", "car z|m/s", "car wx|rad/s", "car wy|rad/s",
                          "car wz|rad/s", "left|rad/s", "lift|m/s", "hand wx|rad/s",
                          "hand wy|rad/s", "hand wz|rad/s"));
  // Only what is commanded in the measure of its joint has that unit.
  EXPECT_THAT(names_of(columns.ctrl), ElementsAre("left|", "lift|m", "geared|", "actuator 3|"));
  EXPECT_THAT(names_of(columns.sensors), ElementsAre("where 0|", "where 1|", "where 2|"));
  for (int joint = 0; joint < model_.raw()->njnt; ++joint) {
    const char* name = mj_id2name(model_.raw(), mjOBJ_JOINT, joint);
    const auto first = static_cast<std::size_t>(model_.raw()->jnt_qposadr[joint]);
    if (name == nullptr) continue;
    EXPECT_TRUE(columns.qpos[first].name.starts_with(name)) << name;
  }
}

TEST_F(Schedule, ConstantsHoldAndTheOthersStay) {
  const auto constants = CtrlSchedule::constant(model_, {{0, 0.5}, {3, -7}});
  ASSERT_TRUE(constants);
  EXPECT_THAT(at(*constants, 0), ElementsAre(0.5, 9, 9, -7));
  EXPECT_THAT(at(*constants, 1e6), ElementsAre(0.5, 9, 9, -7));
  EXPECT_THAT(at(CtrlSchedule(), 1), ElementsAre(9, 9, 9, 9));
  const auto beyond = CtrlSchedule::constant(model_, {{0, 1.5}});
  ASSERT_FALSE(beyond);
  EXPECT_EQ(beyond.error().what, "the command of left must be from -1 to 1, not 1.5");
  EXPECT_FALSE(CtrlSchedule::constant(model_, {{1, NAN}}));
}

TEST_F(Schedule, RowsHoldUntilTheNext) {
  const auto table = read("time [s],lift,qpos left [rad],ctrl left\n0.1,0.2,77,-1\n0.3,0.4,77,1\n");
  ASSERT_TRUE(table) << table.error().what;
  EXPECT_THAT(table->actuators(), ElementsAre(1, 0));
  EXPECT_THAT(at(*table, 0.05), ElementsAre(9, 9, 9, 9)) << "nothing is said yet";
  EXPECT_THAT(at(*table, 0.1), ElementsAre(-1, 0.2, 9, 9));
  EXPECT_THAT(at(*table, 0.299), ElementsAre(-1, 0.2, 9, 9));
  double counted = 0;  // 150 steps of 0.002 s are not 0.3 to the last bit
  for (int i = 0; i < 150; ++i) counted += 0.002;
  EXPECT_THAT(at(*table, counted), ElementsAre(1, 0.4, 9, 9));
  EXPECT_THAT(at(*table, 1000), ElementsAre(1, 0.4, 9, 9));
}

TEST_F(Schedule, FaultsAreToldWithFileAndLine) {
  const std::pair<std::string, std::string> cases[] = {
      {"", "there is no row in it"},
      {"time,left\n", "there is no row in it"},
      {"left,time\n0,0\n", "c.csv:1: the first column must be \"time\", not \"left\""},
      {"time,lefft\n0,0\n", "c.csv:1: there is no actuator \"lefft\" (did you mean \"left\"?)"},
      {"time,left,ctrl left\n0,0,0\n", "two columns"},
      {"time,qpos left [rad]\n0,0\n", "no column names an actuator"},
      {"time,left\n0,0\n0.1\n", "c.csv:3: 1 values in this row, 2 in the header"},
      {"time,left\n0,0\n0,0\n", "c.csv:3: times must"},
      {"time,left\n-1,0\n", "c.csv:2: times must"},
      {"time,left\n0,fast\n", "c.csv:2: \"fast\""},
      {"time,left\nnan,0\n", "c.csv:2"},
      {"time,left\n0,2\n", "c.csv:2: the command of left must be from -1 to 1, not 2"}};
  for (const auto& [table, says] : cases) {
    const auto result = read(table);
    ASSERT_FALSE(result) << table;
    EXPECT_EQ(result.error().code, Errc::bad_input) << table;
    EXPECT_THAT(result.error().what, HasSubstr(says));
  }
  EXPECT_FALSE(CtrlSchedule::read_csv(model_, folder_.path() / "none.csv"));
}

TEST_F(Schedule, ActuatorsAreFoundByNameElseByNumber) {
  EXPECT_EQ(find_actuator(model_, "lift").value(), 1);
  EXPECT_EQ(find_actuator(model_, "actuator 3").value(), 3);
  EXPECT_EQ(find_actuator(model_, "3").value(), 3);
  EXPECT_EQ(find_actuator(model_, "#3").value(), 3);  // as the model is described
  EXPECT_FALSE(find_actuator(model_, "1")) << "that one has a name";
  const Model still = Model::from_mjcf("<mujoco/>").value();
  EXPECT_THAT(find_actuator(still, "left").error().what, HasSubstr("no actuators"));
}

}  // namespace
}  // namespace mjarm
