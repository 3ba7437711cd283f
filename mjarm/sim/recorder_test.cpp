#include "mjarm/sim/recorder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "mjarm/core/number.hpp"
#include "mjarm/sim/worlds_test.hpp"

namespace mjarm {
namespace {

using ::testing::HasSubstr;
using testing::load_text;
using testing::Loaded;
using testing::small_world;
using ::testing::StartsWith;

/// Steps the arm from home and records it.
Recorder record(const Loaded& robot, int steps, const RecordOptions& options = {}) {
  Sim sim(robot.model);
  EXPECT_TRUE(sim.reset("home"));
  Recorder recorder(robot.model, robot.arm, options);
  JointVec q_ref = robot.arm.home;
  recorder.record(sim, q_ref);
  for (int i = 1; i <= steps; ++i) {
    q_ref[1] = robot.arm.home[1] - 0.001 * i;
    EXPECT_TRUE(sim.step(as_span(q_ref)));
    recorder.record(sim, q_ref);
  }
  return recorder;
}

std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> all;
  std::istringstream input(line + ',');
  for (std::string field; std::getline(input, field, ',');) all.push_back(field);
  return all;
}

TEST(Recorder, KeepsWhatTheSimulationHad) {
  const Loaded robot = load_text(small_world());
  const Recorder recorder = record(robot, 20);
  ASSERT_EQ(recorder.size(), 21U);

  Sim sim(robot.model);
  ASSERT_TRUE(sim.reset("home"));
  JointVec q_ref = robot.arm.home;
  for (int i = 1; i <= 20; ++i) {
    q_ref[1] = robot.arm.home[1] - 0.001 * i;
    ASSERT_TRUE(sim.step(as_span(q_ref)));
  }
  const RecordRow row = recorder.row(20);
  EXPECT_EQ(row.time, sim.time());
  EXPECT_EQ(row.q_ref, q_ref);
  EXPECT_EQ(row.q, sim.arm_state(robot.arm).q);
  EXPECT_EQ(row.v, sim.arm_state(robot.arm).v);
  EXPECT_EQ(row.ctrl, q_ref);
  EXPECT_EQ(row.torque, sim.arm_torque(robot.arm));
  EXPECT_EQ(row.X_WT.p, sim.tool(robot.arm).p);
  EXPECT_EQ(row.X_WT.R, sim.tool(robot.arm).R);
  EXPECT_EQ(row.contacts, "floor|box");

  // The planned tool is where the arm would have it at q_ref.
  sim.place(robot.arm, as_span(q_ref));
  EXPECT_EQ(row.X_ref.p, sim.tool(robot.arm).p);
  EXPECT_EQ(row.X_ref.R, sim.tool(robot.arm).R);
}

TEST(Recorder, KeepsEveryNthCall) {
  const Recorder recorder = record(load_text(small_world()), 20, {.every = 5});
  ASSERT_EQ(recorder.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(recorder.row(i).time, 0.01 * static_cast<double>(i), 1e-12);
  }
}

TEST(Recorder, StaysWithinItsMemoryAndEvenlySpaced) {
  for (const std::size_t max : {2U, 7U, 10U}) {
    const Recorder recorder = record(load_text(small_world()), 200, {.max_rows = max});
    EXPECT_LE(recorder.size(), max);
    ASSERT_GE(recorder.size(), 1U);
    EXPECT_EQ(recorder.row(0).time, 0);
    if (recorder.size() < 3) continue;
    const double step = recorder.row(1).time;
    for (std::size_t i = 0; i < recorder.size(); ++i) {
      EXPECT_NEAR(recorder.row(i).time, static_cast<double>(i) * step, 1e-12);
    }
    EXPECT_GT(recorder.row(recorder.size() - 1).time, 0.2) << "the end must not be lost";
  }
}

TEST(Recorder, CsvReadsBackToTheLastBit) {
  const Loaded robot = load_text(small_world());
  const Recorder recorder = record(robot, 30);
  std::istringstream csv(recorder.to_csv());
  std::string line;
  std::getline(csv, line);
  const auto titles = fields(line);
  EXPECT_THAT(line, StartsWith("time [s],q_ref shoulder [rad],q_ref elbow [rad],q shoulder [rad]"));
  EXPECT_THAT(line, HasSubstr("tool_ref x [m]"));
  EXPECT_THAT(line, HasSubstr("torque elbow [N m],contacts"));
  std::size_t rows = 0;
  for (; std::getline(csv, line); ++rows) {
    const auto values = fields(line);
    ASSERT_EQ(values.size(), titles.size());
    const RecordRow row = recorder.row(rows);
    EXPECT_EQ(std::stod(values[0]), row.time);
    EXPECT_EQ(std::stod(values[4]), row.q[1]);
    EXPECT_EQ(std::stod(values[7]), row.X_ref.p.x());
    EXPECT_EQ(std::stod(values[14]), row.X_WT.p.x());
    EXPECT_EQ(std::stod(values[24]), row.torque[1]);
    EXPECT_EQ(values[25], row.contacts);
  }
  EXPECT_EQ(rows, recorder.size());
}

TEST(Recorder, SameRunSameBytesInTheFile) {
  const support::TempFolder folder;
  const auto write = [&](const std::string& name) {
    const Loaded robot = load_text(small_world());
    const auto written = record(robot, 100).write_csv(folder.path() / name);
    EXPECT_TRUE(written);
    return folder.read(name);
  };
  const std::string first = write("a.csv");
  EXPECT_EQ(first, write("b.csv"));
  EXPECT_EQ(std::count(first.begin(), first.end(), '\n'), 102);
}

TEST(Recorder, NamesTheFileItCannotWrite) {
  const support::TempFolder folder;
  const Recorder recorder = record(load_text(small_world()), 1);
  const auto written = recorder.write_csv(folder.path() / "none" / "log.csv");
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().what, HasSubstr("log.csv"));
}

}  // namespace
}  // namespace mjarm
