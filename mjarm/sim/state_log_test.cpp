#include "mjarm/sim/state_log.hpp"

#include <gmock/gmock.h>

#include "mjarm/core/csv.hpp"
#include "mjarm/sim/worlds_test.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using testing::load_text;
using testing::Loaded;
using testing::small_world;

TEST(StateLog, KeepsWhatTheSimulationHad) {
  const Loaded world = load_text(small_world());
  Sim sim(world.model);
  StateLog log(world.model);
  const std::vector<double> ctrl = {0.25, -0.5};
  for (int i = 0; i < 30; ++i) {
    log.record(sim, ctrl);
    ASSERT_TRUE(sim.step(ctrl));
  }
  log.record(sim, ctrl);
  ASSERT_EQ(log.size(), 31U);
  const auto row = log.row(30);
  EXPECT_EQ(row[0], sim.time());
  const auto part = [&row](std::size_t from, std::size_t count) {
    return std::vector<double>(row.begin() + static_cast<long>(from),
                               row.begin() + static_cast<long>(from + count));
  };
  const auto same = [](const std::vector<double>& a, std::span<const double> b) {
    EXPECT_EQ(a, std::vector<double>(b.begin(), b.end()));
  };
  same(part(log.qpos_at(), sim.qpos().size()), sim.qpos());
  same(part(log.qvel_at(), sim.qvel().size()), sim.qvel());
  same(part(log.ctrl_at(), 2), ctrl);
  same(part(log.sensor_at(), sim.sensor_data().size()), sim.sensor_data());
}

TEST(StateLog, TheTableReadsBackToTheLastBit) {
  const Loaded world = load_text(small_world());
  Sim sim(world.model);
  StateLog log(world.model);
  for (int i = 0; i < 5; ++i) {
    log.record(sim, sim.ctrl());
    ASSERT_TRUE(sim.step(std::vector<double>{0.1, 0.2}));
  }
  const support::TempFolder folder;
  ASSERT_TRUE(log.write_csv(folder.path() / "log.csv"));
  const std::vector<std::string> lines = support::lines_of(folder.read("log.csv"));
  ASSERT_EQ(lines.size(), 6U);
  const auto titles = csv_fields(lines[0]);
  EXPECT_EQ(titles.front(), "time [s]");
  EXPECT_EQ(titles[log.qpos_at()], "qpos box_free x [m]");
  EXPECT_EQ(titles[log.ctrl_at()], "ctrl shoulder [rad]");
  EXPECT_EQ(titles[log.sensor_at() + 2], "sensor tool 2");
  for (std::size_t i = 0; i < 5; ++i) {
    const auto fields = csv_fields(lines[i + 1]);
    ASSERT_EQ(fields.size(), titles.size());
    for (std::size_t j = 0; j < fields.size(); ++j) {
      EXPECT_EQ(std::stod(fields[j]), log.row(i)[j]);
    }
  }
}

TEST(StateLog, IsBoundedAndHasTheBeginningAndTheEnd) {
  const Model model = Model::from_mjcf("<mujoco><option timestep=\"0.001\"/></mujoco>").value();
  Sim sim(model);
  StateLog log(model);
  constexpr int kCalls = 250'001;
  for (int i = 0; i < kCalls; ++i) {
    log.record(sim, {});
    if (i + 1 == kCalls) break;
    ASSERT_TRUE(sim.step({}));
  }
  EXPECT_LE(log.size(), StateLog::kMaxRows + 1);
  EXPECT_GE(log.size(), StateLog::kMaxRows / 2);
  EXPECT_EQ(log.row(0)[0], 0);
  EXPECT_EQ(log.row(log.size() - 1)[0], sim.time());
  const double step = log.row(1)[0];
  for (std::size_t i = 1; i + 1 < log.size(); ++i) {
    ASSERT_NEAR(log.row(i)[0] - log.row(i - 1)[0], step, 1e-9) << i;
  }
}

}  // namespace
}  // namespace mjarm
