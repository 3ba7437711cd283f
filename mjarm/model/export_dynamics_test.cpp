// A model that went out and came back as a URDF moves as before: inertia, gravity, Coriolis forces,
// damping and friction by MuJoCo on both sides, and what the format cannot say is told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/model/export.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/shipped_test.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using ::testing::Contains;
using ::testing::EndsWith;
using ::testing::HasSubstr;

Model through_urdf(const Model& model) {
  const support::TempFolder folder;
  const auto exported = export_model(model, ExportFormat::urdf, folder.path());
  if (!exported) throw std::runtime_error(exported.error().what);
  auto again = Model::load(folder.write("out.urdf", exported->content), {.allow_outside = true});
  if (!again) throw std::runtime_error(again.error().what);
  return std::move(*again);
}

/// What MuJoCo says of a model, in the order of `joints`.
class Side {
 public:
  Side(const Model& model, const std::vector<std::string>& joints)
      : model_(model), d_(mj_makeData(model.raw()), mj_deleteData) {
    for (const std::string& joint : joints) {
      joints_.push_back(mj_name2id(model.raw(), mjOBJ_JOINT, joint.c_str()));
    }
  }
  void set(const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
    const mjModel* m = model_.raw();
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      d_->qpos[m->jnt_qposadr[joints_[i]]] = q[i];
      d_->qvel[m->jnt_dofadr[joints_[i]]] = v[i];
    }
    mj_forward(m, d_.get());
  }
  [[nodiscard]] Eigen::MatrixXd mass_matrix_without_rotors() const {
    const mjModel* m = model_.raw();
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> M(m->nv, m->nv);
    mj_fullM(m, d_.get(), M.data());
    const auto n = static_cast<Eigen::Index>(joints_.size());
    Eigen::MatrixXd out(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index k = 0; k < n; ++k) out(i, k) = M(dof(i), dof(k));
      out(i, i) -= m->dof_armature[dof(i)];
    }
    return out;
  }
  [[nodiscard]] Eigen::VectorXd of(const mjtNum* values) const {
    Eigen::VectorXd out(static_cast<Eigen::Index>(joints_.size()));
    for (Eigen::Index i = 0; i < out.size(); ++i) out[i] = values[dof(i)];
    return out;
  }
  [[nodiscard]] const mjModel& model() const { return *model_.raw(); }
  [[nodiscard]] const mjData& data() const { return *d_; }

 private:
  [[nodiscard]] int dof(Eigen::Index i) const { return model_.raw()->jnt_dofadr[joints_[i]]; }

  Model model_;
  std::unique_ptr<mjData, void (*)(mjData*)> d_;
  std::vector<int> joints_;
};

std::vector<std::string> joint_names(const Model& model) {
  std::vector<std::string> names;
  for (int j = 0; j < model.raw()->njnt; ++j) {
    names.emplace_back(mj_id2name(model.raw(), mjOBJ_JOINT, j));
  }
  return names;
}

void expect_same_dynamics(const Model& model, double tolerance) {
  const std::vector<std::string> joints = joint_names(model);
  Side before(model, joints), after(through_urdf(model), joints);
  Rng rng(81);
  const auto n = static_cast<Eigen::Index>(joints.size());
  for (int k = 0; k < 30; ++k) {
    const Eigen::VectorXd q = Eigen::VectorXd::NullaryExpr(n, [&] { return rng.uniform(-2, 2); });
    const Eigen::VectorXd v = Eigen::VectorXd::NullaryExpr(n, [&] { return rng.uniform(-2, 2); });
    before.set(q, v);
    after.set(q, v);
    EXPECT_LT((before.mass_matrix_without_rotors() - after.mass_matrix_without_rotors())
                  .cwiseAbs()
                  .maxCoeff(),
              tolerance);
    EXPECT_LT((before.of(before.data().qfrc_bias) - after.of(after.data().qfrc_bias))
                  .cwiseAbs()
                  .maxCoeff(),
              20 * tolerance);
  }
  EXPECT_EQ(before.of(before.model().dof_damping), after.of(after.model().dof_damping));
  EXPECT_EQ(before.of(before.model().dof_frictionloss), after.of(after.model().dof_frictionloss));
}

TEST(ExportDynamics, ShippedArmsWeighAndTurnAsBefore) {
  for (const char* name : {"ur5e", "panda"}) {
    SCOPED_TRACE(name);
    expect_same_dynamics(testing::shipped(name), 1e-10);
  }
}

/// Hinges and slides with anchors, references, several on one body.
constexpr const char* kManyJoints = R"(<mujoco model="m"><compiler angle="radian"/><worldbody>
  <body name="a" pos="0 0 .5" quat="1 2 0 1">
    <joint name="turn" axis="1 1 0" pos=".1 0 .2" ref=".5" damping=".3" frictionloss=".2"/>
    <joint name="slide" type="slide" axis="0 1 1" ref="-.2" damping=".7"/>
    <joint name="twist" axis="0 0 1" range="-1 2"/>
    <inertial pos=".1 .2 .3" quat="1 .2 .3 .4" mass="3" diaginertia=".3 .2 .4"/>
    <body name="b" pos=".4 0 0"><joint name="last" axis="0 1 0"/>
      <inertial pos="0 0 .1" mass="1" diaginertia=".1 .1 .1"/>
      <geom name="touch" type="ellipsoid" size=".1 .2 .3"/><site name="b" pos="0 0 .2"/></body>
  </body></worldbody></mujoco>)";

TEST(ExportDynamics, SeveralJointsOnABodyDifferByTheTraceOfMassBetweenThem) {
  expect_same_dynamics(Model::from_mjcf(kManyJoints).value(), 1e-5);
}

TEST(ExportDynamics, NotesTellEachThingThatIsNotAsBefore) {
  const Result<Exported> exported =
      export_model(Model::from_mjcf(kManyJoints).value(), ExportFormat::urdf, "/");
  ASSERT_TRUE(exported) << exported.error().what;
  EXPECT_THAT(exported->notes, Contains("not sayable in a URDF and left out: geom 1"));
  EXPECT_THAT(exported->notes,
              Contains("renamed, for a link has that name: b_2"));  // the site
  EXPECT_THAT(exported->notes, Contains(::testing::AllOf(HasSubstr("standard values: "),
                                                         EndsWith("turn, slide, twist, last"))));
  EXPECT_THAT(exported->notes, Contains(HasSubstr("a trace of mass (1e-06 kg each): a_of_turn")));
  for (const std::string& note : exported->notes) EXPECT_EQ(note.find('\n'), std::string::npos);
}

TEST(ExportDynamics, TheSameModelGivesTheSameBytesAndWhatCameBackGivesThemAgain) {
  const support::TempFolder folder;
  for (const char* name : {"ur5e", "panda"}) {
    const Model model = testing::shipped(name);
    for (const ExportFormat format : {ExportFormat::mjcf, ExportFormat::urdf, ExportFormat::mjb}) {
      EXPECT_EQ(export_model(model, format, folder.path())->content,
                export_model(model, format, folder.path())->content);
    }
    const std::string once = export_model(model, ExportFormat::mjcf, folder.path())->content;
    const Model again =
        Model::load(folder.write("again.xml", once), {.allow_outside = true}).value();
    EXPECT_EQ(export_model(again, ExportFormat::mjcf, folder.path())->content, once) << name;
  }
}

TEST(ExportDynamics, LimitsSurviveAsFiguresOfTheFile) {
  const Model model = testing::shipped("panda");
  const Arm before = find_arm(model).value();
  const Arm after = find_arm(through_urdf(model), {.tip = before.tip}).value();
  ASSERT_EQ(after.dof(), before.dof());
  for (int i = 0; i < before.dof(); ++i) {
    EXPECT_EQ(after.joints[i].name, before.joints[i].name);
    EXPECT_EQ(after.limits.velocity[i], before.limits.velocity[i]);
    EXPECT_EQ(after.limits.sources[i].velocity, LimitSource::file);
    EXPECT_EQ(after.limits.sources[i].torque, LimitSource::file);
    // A URDF has no word for these: they are the table's still, for the axes are.
    EXPECT_EQ(after.limits.sources[i].jerk, LimitSource::table);
    EXPECT_EQ(after.limits.jerk[i], before.limits.jerk[i]);
  }
}

TEST(ExportFormats, AnUnknownWordIsNamedWithTheNearest) {
  const auto what = [](const char* word) { return export_format(word).error().what; };
  EXPECT_EQ(what("mjfc"),
            "unknown format \"mjfc\" (did you mean \"mjcf\"?); expected mjcf, urdf or mjb");
  EXPECT_EQ(what("sdformat"), "unknown format \"sdformat\"; expected mjcf, urdf or mjb");
  EXPECT_EQ(what(""), "unknown format \"\"; expected mjcf, urdf or mjb");
  EXPECT_EQ(export_format("").error().code, Errc::usage);
}

TEST(ExportedNames, OfFixedJointsAreNoneThatTheModelHas) {
  const support::TempFolder folder;
  const Model model = Model::from_mjcf(R"(<mujoco><worldbody><body name="b"><joint name="s_fixed"/>
      <geom size=".1"/><site name="s"/></body></worldbody></mujoco>)")
                          .value();
  const auto out = export_model(model, ExportFormat::urdf, folder.path());
  ASSERT_TRUE(out);
  const auto again = Model::load(folder.write("out.urdf", out->content));
  EXPECT_TRUE(again) << again.error().what;
}

}  // namespace
}  // namespace mjarm
