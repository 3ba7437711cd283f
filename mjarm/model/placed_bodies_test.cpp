#include "mjarm/model/placed_bodies.hpp"

#include <gmock/gmock.h>
#include <mujoco/mujoco.h>

#include <memory>

#include "mjarm/core/rotation.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm {
namespace {

/// Where MuJoCo has a body or geom in the initial state.
Pose pose_in(const Model& model, int type, const char* name) {
  const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(model.raw()), mj_deleteData);
  mj_kinematics(model.raw(), data.get());
  const int id = mj_name2id(model.raw(), type, name);
  const mjtNum *p = data->xpos, *R = data->xmat;
  if (type == mjOBJ_GEOM) p = data->geom_xpos, R = data->geom_xmat;
  using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  return {.p = Eigen::Vector3d(p + 3 * id), .R = Eigen::Map<const Rows>(R + 9 * id)};
}

TEST(PlacedBodies, StandThereWithAllThatHangsOnThem) {
  const Model cabinet = load_robot("franka_emika_panda/cabinet.xml").value().model;
  const Pose X_WC{.p = {0.7, -0.1, 0.25}, .R = from_euler({0.1, -0.2, 0.3})};
  const PlacedBody place[] = {{"cabinet", X_WC}};
  const Model other = with_bodies_at(cabinet, place).value();
  const Pose before = pose_in(cabinet, mjOBJ_BODY, "cabinet");
  for (const char* geom : {"cabinet_top", "drawer2_handle"}) {
    const Pose wanted = X_WC * before.inverse() * pose_in(cabinet, mjOBJ_GEOM, geom);
    const Pose is = pose_in(other, mjOBJ_GEOM, geom);
    EXPECT_LT((is.p - wanted.p).norm() + (is.R - wanted.R).norm(), 1e-12) << geom;
  }
  EXPECT_EQ(pose_in(other, mjOBJ_BODY, "hand").p, pose_in(cabinet, mjOBJ_BODY, "hand").p);
  EXPECT_EQ(other.nq(), cabinet.nq());
  EXPECT_NE(before.p, X_WC.p) << "the model itself was changed";
}

TEST(PlacedBodies, AreNamedWhereTheyCannotBePut) {
  const Model cabinet = load_robot("franka_emika_panda/cabinet.xml").value().model;
  for (const char* name : {"wardrobe", "drawer1", "world"}) {
    const PlacedBody place[] = {{name, {}}};
    const auto refused = with_bodies_at(cabinet, place);
    ASSERT_FALSE(refused) << name;
    EXPECT_THAT(refused.error().what, ::testing::HasSubstr(name));
  }
}

}  // namespace
}  // namespace mjarm
