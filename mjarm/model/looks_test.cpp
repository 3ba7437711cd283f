#include "mjarm/model/looks.hpp"

#include <gmock/gmock.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <memory>

#include "mjarm/model/robot.hpp"

namespace mjarm {
namespace {

/// Where a second of steps leads.
std::vector<double> after_a_second(const Model& model) {
  const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(model.raw()), mj_deleteData);
  mj_resetDataKeyframe(model.raw(), data.get(), 0);
  while (data->time < 1) mj_step(model.raw(), data.get());
  return {data->qpos, data->qpos + model.nq()};
}

TEST(Looks, ChangeColoursAndNothingThatMoves) {
  const Robot robot = load_robot("franka_emika_panda/pick.xml").value();
  const Model other =
      with_looks(
          robot.model,
          {.geoms = {{"can", {1, 0.25F, 0, 1}}},
           .lights = {{.name = "key", .direction_W = {0, 2, -2}, .diffuse = {0.5, 0.25, 1}}}})
          .value();
  const mjModel& m = *other.raw();
  const int can = mj_name2id(&m, mjOBJ_GEOM, "can"), key = mj_name2id(&m, mjOBJ_LIGHT, "key");
  EXPECT_EQ(m.geom_rgba[4 * can + 1], 0.25F);
  EXPECT_NEAR(m.light_dir[3 * key + 1], std::sqrt(0.5), 1e-12);
  EXPECT_EQ(m.light_diffuse[3 * key + 2], 1);
  EXPECT_NE(robot.model.raw()->geom_rgba[4 * can + 1], 0.25F) << "the model itself was changed";
  EXPECT_EQ(after_a_second(other), after_a_second(robot.model));
}

TEST(Looks, NameWhatTheModelDoesNotHave) {
  const Robot robot = load_robot("franka_emika_panda/pick.xml").value();
  const auto geom = with_looks(robot.model, {.geoms = {{"cup"}}});
  ASSERT_FALSE(geom);
  EXPECT_THAT(geom.error().what, ::testing::HasSubstr("\"cup\""));
  EXPECT_FALSE(with_looks(robot.model, {.lights = {{"moon"}}}));
}

}  // namespace
}  // namespace mjarm
