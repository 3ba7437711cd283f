#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/robot.hpp"
#include "tests/support/temp_folder.hpp"

// What our grippers hold stays where it is, and by friction alone: a free body, plain MuJoCo.
namespace mjarm {
namespace {

using Eigen::Vector3d;

struct Held {
  const char* file;  ///< the robot
  const char* geom;  ///< of the part
};

Robot loaded(const std::string& file) {
  auto robot = load_robot(file);
  if (!robot) throw std::runtime_error(robot.error().what);
  return std::move(*robot);
}

class HeldPart {
 public:
  explicit HeldPart(const Held& held, bool icy = false)
      : robot_(loaded(folder_
                          .write("scene.xml", std::string("<mujoco><include file='") + held.file +
                                                  "'/><worldbody><body name='part' " +
                                                  "pos='0 0 3'><freejoint/><geom " + held.geom +
                                                  "/></body></worldbody></mujoco>")
                          .string())),
        model_(mj_copyModel(nullptr, robot_.model.raw()), mj_deleteModel),
        data_(mj_makeData(model_.get()), mj_deleteData) {
    if (icy) {
      for (int g = 0; g < static_cast<int>(model_->ngeom); ++g) {
        for (int k = 0; k < 3; ++k) model_->geom_friction[3 * g + k] = 0;
      }
    }
    mj_resetDataKeyframe(model_.get(), data_.get(), 0);
    site_ = mj_name2id(model_.get(), mjOBJ_SITE, robot_.arm.tip.c_str());
    part_ = mj_name2id(model_.get(), mjOBJ_BODY, "part");
    mj_forward(model_.get(), data_.get());
    mjtNum* qpos = data_->qpos + model_->jnt_qposadr[model_->body_jntadr[part_]];
    mju_copy3(qpos, data_->site_xpos + 3 * site_);
    mju_mat2Quat(qpos + 3, data_->site_xmat + 9 * site_);
    close();
  }

  /// [m] of the part in the tool's frame.
  [[nodiscard]] Vector3d place() const {
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(data_->site_xmat +
                                                                           9 * site_);
    return R.transpose() *
           (Vector3d(data_->xpos + 3 * part_) - Vector3d(data_->site_xpos + 3 * site_));
  }

  void rest(double seconds) {
    for (double end = data_->time + seconds; data_->time < end;) mj_step(model_.get(), data_.get());
  }

  /// To and fro along y, 0.5 m/s in the middle; gives the highest speed of the part [m/s].
  double carry(double seconds) {
    const double amplitude = 0.15, rate = 0.5 / amplitude;
    const IkSolver ik(robot_.arm);
    JointVec q = robot_.arm.home;
    const Pose X_WT = fk(robot_.arm, as_span(q));  // what is commanded already
    double fastest = 0;
    model_->opt.timestep = 0.00025;
    for (double begin = data_->time; data_->time < begin + seconds;) {
      const double t = data_->time - begin;
      // From rest, as its square rises.
      const double share = std::min(t, 1.0);
      const Pose goal{X_WT.p + Vector3d(0, share * share * amplitude * std::sin(rate * t), 0),
                      X_WT.R};
      const auto answer = ik.solve(goal, as_span(q));
      if (answer) q = answer->q;
      for (int i = 0; i < robot_.arm.dof(); ++i) {
        data_->ctrl[robot_.arm.joints[static_cast<std::size_t>(i)].actuator->id] = q[i];
      }
      mj_step(model_.get(), data_.get());
      const int dof = model_->body_dofadr[part_];
      fastest = std::max(fastest, Vector3d(data_->qvel + dof).norm());
    }
    return fastest;
  }

 private:
  void close() {
    const Gripper& gripper = *robot_.arm.gripper;
    const double weight = model_->opt.gravity[2];
    model_->opt.gravity[2] = 0;
    data_->ctrl[gripper.id] = gripper.ctrl_closed;
    rest(0.8);
    model_->opt.gravity[2] = weight;
    rest(1);
  }

  support::TempFolder folder_;
  Robot robot_;
  std::unique_ptr<mjModel, void (*)(mjModel*)> model_;
  std::unique_ptr<mjData, void (*)(mjData*)> data_;
  int site_ = 0, part_ = 0;
};

class Grip : public ::testing::TestWithParam<Held> {};

TEST_P(Grip, HoldsByFrictionAlone) {
  HeldPart part(GetParam());
  const Vector3d before = part.place();
  part.rest(6);
  EXPECT_LT((part.place() - before).norm(), 1e-5) << "in a tenth of a minute";
  const Vector3d still = part.place();
  EXPECT_GT(part.carry(4), 0.4);
  EXPECT_LT((part.place() - still).norm(), 2e-4) << (part.place() - still).transpose();
  HeldPart icy(GetParam(), true);
  icy.rest(1);
  EXPECT_GT(icy.place().norm(), 0.1);
}

constexpr const char* kUr5eGrip = "universal_robots_ur5e/ur5e_gripper.xml";
constexpr const char* kPandaGrip = "franka_emika_panda/panda.xml";
INSTANTIATE_TEST_SUITE_P(
    Parts, Grip,
    ::testing::Values(Held{kUr5eGrip, "type='box' size='0.025 0.03 0.03' mass='0.5'"},
                      Held{kUr5eGrip, "type='cylinder' size='0.02 0.04' mass='0.2'"},
                      Held{kPandaGrip, "type='cylinder' size='0.02 0.03' mass='0.2'"}));

}  // namespace
}  // namespace mjarm
