// URDF files that load though something in them cannot be: what is mended, what is said of it, and
// that nothing else changes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "mjarm/core/rng.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/model.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using ::testing::Contains;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A chain of links l0, l1, ... joined by hinges about z, each `step` along x from the one before;
/// `inside` of every link but the first.
std::string hinge_chain(int links, double step, const std::string& inside) {
  std::string xml = "<robot name=\"r\"><link name=\"l0\"/>";
  for (int i = 1; i < links; ++i) {
    const std::string n = std::to_string(i), before = std::to_string(i - 1);
    xml += "<link name=\"l" + n + "\">" + inside + "</link><joint name=\"j" + n +
           "\" type=\"continuous\"><parent link=\"l" + before + "\"/><child link=\"l" + n +
           "\"/><origin xyz=\"" + std::to_string(step) + " 0 0\"/><axis xyz=\"0 0 1\"/></joint>";
  }
  return xml + "</robot>";
}

std::string inertial_of(double mass, const std::string& entries) {
  return "<inertial><mass value=\"" + std::to_string(mass) + "\"/><inertia " + entries +
         "/></inertial>";
}

Model load_urdf_text(const std::string& text) {
  const support::TempFolder folder;
  auto model = Model::load(folder.write("r.urdf", text));
  if (!model) throw std::runtime_error(model.error().what);
  return std::move(*model);
}

int most_contacts(const Model& model) {
  const mjModel* m = model.raw();
  const std::unique_ptr<mjData, void (*)(mjData*)> d(mj_makeData(m), mj_deleteData);
  Rng rng(51);
  int most = 0;
  for (int n = 0; n < 50; ++n) {
    for (int i = 0; i < m->nq; ++i) d->qpos[i] = rng.uniform(-3, 3);
    mj_kinematics(m, d.get());
    mj_collision(m, d.get());
    most = std::max(most, static_cast<int>(d->ncon));
  }
  return most;
}

/// Entries of a tensor that is diagonal but for `ixy`.
std::string tensor(const std::string& ixx, const std::string& iyy, const std::string& izz,
                   const std::string& ixy) {
  return "ixx=\"" + ixx + "\" iyy=\"" + iyy + "\" izz=\"" + izz + "\" ixy=\"" + ixy +
         "\" ixz=\"0\" iyz=\"0\"";
}

const std::string kSound = tensor("1", "1", "1", "0");
constexpr const char* kBall =
    "<collision><geometry><sphere radius=\"0.1\"/></geometry></collision>";

TEST(MendedUrdf, LinksThatTouchInEveryPostureAreOnePiece) {
  // 5 cm apart, 20 cm wide: each touches the next but one however it turns; neighbours never count.
  const Model model = load_urdf_text(hinge_chain(4, 0.05, inertial_of(1, kSound) + kBall));
  EXPECT_THAT(model.warnings(), Contains(::testing::AllOf(HasSubstr("touch in every posture"),
                                                          EndsWith(": l1 - l3"))));
  EXPECT_EQ(model.raw()->nexclude, 1);
  EXPECT_EQ(most_contacts(model), 0);
}

TEST(MendedUrdf, LinksThatTouchNowAndThenStayTwo) {
  const Model model = load_urdf_text(hinge_chain(4, 0.15, inertial_of(1, kSound) + kBall));
  EXPECT_THAT(model.warnings(), IsEmpty());
  EXPECT_EQ(model.raw()->nexclude, 0);
  EXPECT_GT(most_contacts(model), 0);
}

TEST(MendedUrdf, ProductsOfInertiaThatNoBodyHasAreLeftOut) {
  const Model model =
      load_urdf_text(hinge_chain(3, 1, inertial_of(2, tensor("1", "1.5", "2", "3"))));
  EXPECT_THAT(model.warnings(), Contains(::testing::AllOf(HasSubstr("lose its products of inertia"),
                                                          EndsWith(": l1, l2"))));
  const mjModel* m = model.raw();
  for (const char* link : {"l1", "l2"}) {
    const int body = mj_name2id(m, mjOBJ_BODY, link);
    ASSERT_GE(body, 0);
    EXPECT_DOUBLE_EQ(m->body_mass[body], 2);
    EXPECT_NEAR(
        m->body_inertia[3 * body] + m->body_inertia[3 * body + 1] + m->body_inertia[3 * body + 2],
        4.5, 1e-12);
    // About z itself: what turns the hinge is what the file says.
    EXPECT_NEAR(*std::max_element(m->body_inertia + 3 * body, m->body_inertia + 3 * body + 3), 2,
                1e-12);
  }
}

TEST(MendedUrdf, ProductsThatABodyCanHaveStay) {
  const Model model =
      load_urdf_text(hinge_chain(2, 1, inertial_of(2, tensor("1", "1", "1", "0.1"))));
  EXPECT_THAT(model.warnings(), IsEmpty());
  const mjModel* m = model.raw();
  const double* moments = m->body_inertia + 3 * mj_name2id(m, mjOBJ_BODY, "l1");
  // Eigenvalues of [[1, .1], [.1, 1]] are 0.9 and 1.1.
  EXPECT_NEAR(*std::max_element(moments, moments + 3), 1.1, 1e-12);
  EXPECT_NEAR(*std::min_element(moments, moments + 3), 0.9, 1e-12);
}

TEST(MendedUrdf, MassFixedToALinkMovesWithItAndNoTraceIsAdded) {
  std::string text = hinge_chain(2, 1, "");
  text.insert(text.find("</robot>"),
              "<link name=\"load\">" + inertial_of(3, kSound) +
                  "</link><joint name=\"f\" type=\"fixed\"><parent link=\"l1\"/><child "
                  "link=\"load\"/><origin xyz=\"2 0 0\"/></joint>");
  const Model model = load_urdf_text(text);
  EXPECT_THAT(model.warnings(), IsEmpty());
  EXPECT_DOUBLE_EQ(model.raw()->body_subtreemass[0], 3);
  const std::unique_ptr<mjData, void (*)(mjData*)> d(mj_makeData(model.raw()), mj_deleteData);
  mj_forward(model.raw(), d.get());
  // 3 kg at 2 m from the hinge, and 1 kg m^2 of its own.
  EXPECT_NEAR(d->M[0], 3 * 2 * 2 + 1, 1e-12);
}

TEST(MendedUrdf, MassGuessedFromShapesIsThatOfWater) {
  const Model model = load_urdf_text(hinge_chain(2, 1, kBall));
  EXPECT_THAT(model.warnings(),
              Contains(::testing::AllOf(HasSubstr("at the density of water"), EndsWith(": l1"))));
  const int body = mj_name2id(model.raw(), mjOBJ_BODY, "l1");
  EXPECT_NEAR(model.raw()->body_mass[body], 1000 * 4.0 / 3 * mjPI * 1e-3, 1e-9);
}

TEST(MendedUrdf, AMassWithoutInertiaKeepsItsMass) {
  const Model model = load_urdf_text(hinge_chain(2, 1, "<inertial><mass value=\"4\"/></inertial>"));
  EXPECT_DOUBLE_EQ(model.raw()->body_mass[mj_name2id(model.raw(), mjOBJ_BODY, "l1")], 4);
  EXPECT_THAT(model.warnings(), Contains(HasSubstr(": l1 (1e-6 kg each)")));
}

TEST(MendedUrdf, TheTextMujocoWasGivenIsAUrdfOfTheSameArm) {
  const Model model =
      load_urdf_text(hinge_chain(4, 0.05, inertial_of(2, tensor("1", "1", "1", "5")) + kBall));
  EXPECT_THAT(model.warnings(), Not(IsEmpty()));
  const Model again = load_urdf_text(model.urdf_text());
  for (const std::string& warning : again.warnings()) {  // what was mended needs it no more
    EXPECT_THAT(warning, Not(HasSubstr("products of inertia")));
  }
  ASSERT_EQ(again.nq(), model.nq());
  for (int b = 1; b < model.raw()->nbody; ++b) {
    EXPECT_EQ(again.raw()->body_mass[b], model.raw()->body_mass[b]);
  }
}

}  // namespace
}  // namespace mjarm
