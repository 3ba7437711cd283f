// The shipped models: what they hold, where their frames lie, that they stand, hold, drive and
// grip.
#include <mujoco/mujoco.h>

#include <array>
#include <cmath>
#include <memory>
#include <ostream>

#include "tests/robots.hpp"
#include "tests/support/constants.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using support::kPi;
using testing::load;
using testing::models_folder;

constexpr const char* kUr5e = "universal_robots_ur5e/ur5e.xml";
constexpr const char* kUr5eUrdf = "universal_robots_ur5e/ur5e.urdf";
constexpr const char* kPanda = "franka_emika_panda/panda.xml";
constexpr const char* kPandaUrdf = "franka_emika_panda/panda.urdf";

Model shipped(const char* file) { return load(models_folder() / file); }

Eigen::Vector3d vector(const double* from) { return {from[0], from[1], from[2]}; }

/// A bare MuJoCo state, at the keyframe `home` where there is one. The oracle of many tests.
class State {
 public:
  explicit State(const Model& model) : m_(model.raw()), d_(mj_makeData(m_), &mj_deleteData) {
    const int home = mj_name2id(m_, mjOBJ_KEY, "home");
    if (home >= 0) mj_resetDataKeyframe(m_, d_.get(), home);
    mj_forward(m_, d_.get());
  }
  mjData* operator->() const { return d_.get(); }
  [[nodiscard]] mjData* get() const { return d_.get(); }
  /// Steps the simulation for `seconds` [s].
  void run(double seconds) const {
    const double end = d_->time + seconds - m_->opt.timestep / 2;
    while (d_->time < end) mj_step(m_, d_.get());
  }

 private:
  const mjModel* m_;
  std::unique_ptr<mjData, decltype(&mj_deleteData)> d_;
};

/// One robot in both formats, and what ties the two together.
struct Twin {
  const char* name;
  const char* mjcf;
  const char* urdf;
  const char* mjcf_tip;
  const char* urdf_tip;
  Pose X_WU;  ///< root of the URDF in the world of the MJCF
};

void PrintTo(const Twin& twin, std::ostream* out) { *out << twin.name; }

class Twins : public ::testing::TestWithParam<Twin> {};

TEST_P(Twins, MoveAlike) {
  const Model mjcf = shipped(GetParam().mjcf);
  const Model urdf = shipped(GetParam().urdf);
  const Arm arm = testing::arm_of(mjcf, GetParam().mjcf_tip);
  const Arm other = testing::arm_of(urdf, GetParam().urdf_tip);
  ASSERT_EQ(arm.dof(), other.dof());
  Rng rng(11);
  for (int i = 0; i < 200; ++i) {
    const auto qpos = testing::random_qpos(urdf, rng);
    const Pose X = fk(arm, as_span(testing::joints_of(arm, qpos)));
    const Pose Y = GetParam().X_WU * fk(other, as_span(testing::joints_of(other, qpos)));
    EXPECT_LT((X.p - Y.p).norm(), 1e-9);
    EXPECT_LT(angle_between(X.R, Y.R), 1e-9);
  }
}

TEST_P(Twins, WeighAlike) {
  const Model mjcf = shipped(GetParam().mjcf);
  const Model urdf = shipped(GetParam().urdf);
  ASSERT_EQ(mjcf.nv(), urdf.nv());
  const Eigen::Map<const Eigen::VectorXd> armature(mjcf.raw()->dof_armature, mjcf.nv());
  Dynamics one(mjcf);
  Dynamics other(urdf);
  Rng rng(12);
  for (int i = 0; i < 100; ++i) {
    const auto q = testing::random_qpos(urdf, rng);
    const auto v = testing::random_vector(mjcf.nv(), 1.5, rng);
    Eigen::MatrixXd M = one.mass_matrix(q);
    M.diagonal() -= armature;
    EXPECT_LT((M - other.mass_matrix(q)).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((one.gravity(q) - other.gravity(q)).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((one.bias(q, v) - other.bias(q, v)).cwiseAbs().maxCoeff(), 1e-9);
  }
}

// The Panda's MJCF rounds the quaternion of the hand to seven digits; its URDF turns it as far.
INSTANTIATE_TEST_SUITE_P(
    Shipped, Twins,
    ::testing::Values(
        Twin{"Ur5eTool0", kUr5e, kUr5eUrdf, "attachment_site", "tool0", testing::half_turn()},
        Twin{"Ur5eEeLink", kUr5e, kUr5eUrdf, "ee_link", "ee_link", testing::half_turn()},
        Twin{"PandaFlange", kPanda, kPandaUrdf, "panda_link8", "panda_link8", {}},
        Twin{"PandaHand", kPanda, kPandaUrdf, "hand_tcp", "panda_hand_tcp", {}}),
    [](const auto& twin) { return std::string(twin.param.name); });

TEST(Models, EveryShippedModelLoadsAndIsNamedThroughout) {
  const auto models = shipped_models();
  ASSERT_FALSE(models.empty());
  for (const ShippedModel& entry : models) {
    const Model model = load(entry.file);
    EXPECT_NEAR(model.timestep(), 0.002, 1e-15) << entry.name;
    if (model.format() == ModelFormat::urdf) continue;
    for (int g = 0; g < model.raw()->ngeom; ++g) {
      EXPECT_NE(mj_id2name(model.raw(), mjOBJ_GEOM, g), nullptr) << entry.name << " geom " << g;
    }
  }
}

TEST(Models, UrdfsKeepTheirSpeedAndEffort) {
  const Model ur5e = shipped(kUr5eUrdf);
  EXPECT_NEAR(ur5e.urdf_velocity_limit("shoulder_pan_joint"), kPi, 1e-12);
  EXPECT_NEAR(ur5e.urdf_velocity_limit("wrist_3_joint"), kPi, 1e-12);
  EXPECT_NEAR(ur5e.urdf_effort_limit("elbow_joint"), 150, 1e-12);
  EXPECT_NEAR(ur5e.urdf_effort_limit("wrist_1_joint"), 28, 1e-12);
  const Model panda = shipped(kPandaUrdf);
  EXPECT_NEAR(panda.urdf_velocity_limit("panda_joint4"), 2.175, 1e-12);
  EXPECT_NEAR(panda.urdf_velocity_limit("panda_joint5"), 2.61, 1e-12);
  EXPECT_NEAR(panda.urdf_velocity_limit("panda_finger_joint1"), 0.2, 1e-12);
  EXPECT_NEAR(panda.urdf_effort_limit("panda_joint7"), 12, 1e-12);
}

TEST(Models, Ur5ePosesAreThoseOfTheController) {
  const Arm arm = testing::arm_of(shipped("universal_robots_ur5e/scene.xml"));
  EXPECT_EQ(arm.tip, "attachment_site");
  EXPECT_LT((fk(arm, as_span(arm.home)).p - Eigen::Vector3d(-0.134, 0.492, 0.488)).norm(), 1e-3);
  const std::array seed = {-1.57, -1.34, 2.65, -1.3, 1.55, 0.0};
  EXPECT_LT((fk(arm, seed).p - Eigen::Vector3d(-0.136, 0.297, 0.097)).norm(), 1e-3);
  const std::array below_the_floor = {0.0, 0.0, 2.65, -1.3, 1.55, 0.0};
  EXPECT_NEAR(fk(arm, below_the_floor).p.z(), -0.141, 1e-3);
}

TEST(Models, Ur5eToolFramesPointOutOfTheFlange) {
  const Model model = shipped(kUr5e);
  const Arm z_out = testing::arm_of(model, "attachment_site");
  const Arm x_out = testing::arm_of(model, "ee_link");
  const Pose X = fk(z_out, as_span(z_out.home));
  const Pose Y = fk(x_out, as_span(x_out.home));
  EXPECT_LT((X.p - Y.p).norm(), 1e-12);
  EXPECT_LT((X.R.col(2) - Y.R.col(0)).norm(), 1e-12);
  EXPECT_LT((X.R.col(2) + Eigen::Vector3d::UnitZ()).norm(), 1e-4) << "home looks down";
}

TEST(Models, UrdfHoldsBothBaseFrames) {
  const Model model = shipped(kUr5eUrdf);
  const std::vector<double> q(6, 0.0);
  const auto X = frame_pose(model, "base", q);
  ASSERT_TRUE(X.has_value()) << X.error().what;
  EXPECT_LT(X->p.norm(), 1e-12);
  EXPECT_LT(angle_between(X->R, testing::half_turn().R), 1e-12);
}

TEST(Models, PandaTipIsBetweenTheFingers) {
  const Model model = shipped("franka_emika_panda/scene.xml");
  const Arm arm = testing::arm_of(model);
  EXPECT_EQ(arm.tip, "hand_tcp");
  EXPECT_EQ(arm.dof(), 7);
  ASSERT_TRUE(arm.gripper.has_value());
  EXPECT_EQ(arm.gripper->drives[0].actuator, "actuator8");
  EXPECT_EQ(arm.gripper->drives[0].ctrl_open, 255);
  EXPECT_EQ(arm.gripper->drives[0].ctrl_closed, 0);
  const State state(model);
  const std::span qpos(state->qpos, static_cast<std::size_t>(model.nq()));
  const auto left = frame_pose(model, "left_finger", qpos);
  const auto right = frame_pose(model, "right_finger", qpos);
  ASSERT_TRUE(left.has_value() && right.has_value());
  const Pose X = fk(arm, as_span(testing::joints_of(arm, qpos)));
  const Eigen::Vector3d middle = (left->p + right->p) / 2;
  EXPECT_LT((X.p - (middle + 0.045 * X.R.col(2))).norm(), 1e-9);
}

/// Servos alone let the arm sag by gravity over gain: millimetres, less than 0.01 rad.
TEST(Models, ServosHoldHomeWithoutContact) {
  for (const char* file : {"universal_robots_ur5e/scene.xml", "franka_emika_panda/scene.xml",
                           "franka_emika_panda/panda_nohand.xml"}) {
    SCOPED_TRACE(file);
    const Model model = shipped(file);
    const State state(model);
    EXPECT_EQ(state->ncon, 0);
    const Eigen::VectorXd start = Eigen::Map<Eigen::VectorXd>(state->qpos, model.nq());
    state.run(3);
    const Eigen::VectorXd end = Eigen::Map<Eigen::VectorXd>(state->qpos, model.nq());
    EXPECT_LT((end - start).cwiseAbs().maxCoeff(), 0.01);
    EXPECT_GT((end - start).cwiseAbs().maxCoeff(), 1e-4) << "gravity must act";
    EXPECT_LT(Eigen::Map<Eigen::VectorXd>(state->qvel, model.nv()).norm(), 1e-6);
    EXPECT_EQ(state->ncon, 0);
  }
}

TEST(Models, Ur5eSceneHasTheGreenBall) {
  const Model model = shipped("universal_robots_ur5e/scene.xml");
  const mjModel* m = model.raw();
  const int ball = mj_name2id(m, mjOBJ_GEOM, "target");
  ASSERT_GE(ball, 0);
  const State state(model);
  EXPECT_LT((vector(state->geom_xpos + 3 * ball) - Eigen::Vector3d(-0.13, 0.5, 0.1)).norm(), 1e-12);
  EXPECT_EQ(m->geom_size[3 * ball], 0.02);
  EXPECT_EQ(m->geom_rgba[4 * ball + 3], 0.5F);
  EXPECT_EQ(m->geom_contype[ball] | m->geom_conaffinity[ball], 0);
  EXPECT_GE(mj_name2id(m, mjOBJ_CAMERA, "overview"), 0);
}

TEST(Models, HelloHangs) {
  const Model model = shipped("hello.xml");
  EXPECT_EQ(model.nv(), 0);
  const mjModel* m = model.raw();
  const int floor = mj_name2id(m, mjOBJ_GEOM, "floor");
  const int wall = mj_name2id(m, mjOBJ_GEOM, "wall");
  ASSERT_TRUE(floor >= 0 && wall >= 0);
  EXPECT_EQ(vector(m->geom_size + 3 * floor), Eigen::Vector3d(10, 10, 0.1));
  EXPECT_EQ(vector(m->geom_size + 3 * wall), Eigen::Vector3d(0.1, 5, 1));
  const State state(model);
  state.run(1);
  EXPECT_EQ(state->geom_xpos[3 * wall + 2], 1);
}

TEST(Models, CarDrivesAndTurns) {
  const Model model = shipped("car.xml");
  ASSERT_EQ(model.nu(), 2);
  const State state(model);
  state.run(0.5);
  state->ctrl[0] = 0.5;
  state.run(2);
  EXPECT_GT(state->qpos[0], 0.4) << "forward is along x";
  EXPECT_LT(std::abs(state->qpos[1]), 0.01) << "straight";
  ASSERT_EQ(model.raw()->nsensordata, 2);
  EXPECT_NEAR(state->sensordata[0], state->sensordata[1], 1e-12);
  EXPECT_GT(state->sensordata[0], 0);
  const double x = state->qpos[0];
  state->ctrl[0] = 0;
  state->ctrl[1] = 1;
  state.run(1);
  const double yaw = 2 * std::atan2(state->qpos[6], state->qpos[3]);
  EXPECT_GT(yaw, 0.5) << "turns left";
  EXPECT_LT(std::abs(state->qpos[0] - x), 0.2) << "on the spot";
  EXPECT_NEAR(state->sensordata[0], -state->sensordata[1], 1e-12);
  EXPECT_GT(vector(state->xmat + 9 + 6).z(), 0.999) << "upright";
}

/// A cube between the open fingers is held against gravity once they close, and falls if not.
TEST(Models, HandHoldsACube) {
  const support::TempFolder folder;
  const auto file = folder.write(
      "grip.xml", "<mujoco><include file=\"" + (models_folder() / kPanda).string() +
                      "\"/><worldbody><body name=\"cube\" pos=\"0.5545 0 0.5195\"><freejoint/>"
                      "<geom name=\"cube\" type=\"box\" size=\".02 .02 .02\" mass=\".1\"/>"
                      "</body></worldbody></mujoco>");
  const Model model = *Model::load(file, {.allow_outside = true});
  const int cube = mj_name2id(model.raw(), mjOBJ_BODY, "cube");
  const int tip = mj_name2id(model.raw(), mjOBJ_SITE, "hand_tcp");
  for (const double ctrl : {0.0, 255.0}) {
    const State state(model);
    for (int i = 0; i < 3; ++i) state->qpos[9 + i] = state->site_xpos[3 * tip + i];
    state->ctrl[7] = ctrl;
    while (state->time < 2) {
      // The cube floats until the fingers have had time to close.
      const double weight = state->time < 0.5 ? 0.1 * 9.81 : 0;
      state->xfrc_applied[6 * cube + 2] = weight;
      mj_step(model.raw(), state.get());
    }
    const Eigen::Vector3d offset =
        vector(state->xpos + 3 * cube) - vector(state->site_xpos + 3 * tip);
    if (ctrl == 0) {
      EXPECT_LT(offset.norm(), 0.01) << "closed";
    } else {
      EXPECT_GT(offset.norm(), 0.3) << "open";
    }
  }
}

}  // namespace
}  // namespace mjarm
