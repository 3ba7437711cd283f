#include "mjarm/model/export.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <memory>
#include <string>

#include "mjarm/core/rng.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/test_chain_internal.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using support::TempFolder;
using ::testing::HasSubstr;
using Data = std::unique_ptr<mjData, void (*)(mjData*)>;
using RowMatrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Model load(const std::filesystem::path& file) {
  auto model = Model::load(file);
  if (!model) throw std::runtime_error(model.error().what);
  return std::move(*model);
}

/// `model` written into `folder` as `name` and read again.
Model round_trip(const Model& model, ExportFormat format, const TempFolder& folder,
                 const std::string& name) {
  const auto exported = export_model(model, format, folder.path());
  if (!exported) throw std::runtime_error(exported.error().what);
  return load(folder.write(name, exported->content));
}

std::string mjb(const Model& model) {
  const auto exported = export_model(model, ExportFormat::mjb, "/");
  return exported ? exported->content : exported.error().what;
}

/// Tensor of inertia of a body in its own axes.
Eigen::Matrix3d inertia(const mjModel* m, int b) {
  const double* q = m->body_iquat + 4 * b;
  const Eigen::Matrix3d R = to_matrix(Quat(q[0], q[1], q[2], q[3]));
  return R * Eigen::Vector3d(m->body_inertia + 3 * b).asDiagonal() * R.transpose();
}

/// Every body, site and joint of `a` is in `b` under its name, and everything hangs, weighs and
/// moves alike. In `b` a site may be a body.
void expect_same(const Model& model_a, const Model& model_b, int draws) {
  const mjModel* a = model_a.raw();
  const mjModel* b = model_b.raw();
  ASSERT_EQ(a->njnt, b->njnt);
  const Data da(mj_makeData(a), mj_deleteData), db(mj_makeData(b), mj_deleteData);
  const auto id = [&](mjtObj type, const char* name) { return mj_name2id(b, type, name); };
  for (int i = 1; i < a->nbody; ++i) {
    const char* name = mj_id2name(a, mjOBJ_BODY, i);
    const int other = id(mjOBJ_BODY, name);
    ASSERT_GE(other, 0) << name;
    EXPECT_NEAR(a->body_mass[i], b->body_mass[other], 1e-12 + 1e-12 * a->body_mass[i]) << name;
    const Eigen::Matrix3d I = inertia(a, i);
    EXPECT_LT((I - inertia(b, other)).norm(), 1e-12 * (1 + I.norm())) << name;
  }
  Rng rng(3);
  for (int n = 0; n < draws; ++n) {
    for (int j = 0; j < a->njnt; ++j) {
      const int other = id(mjOBJ_JOINT, mj_id2name(a, mjOBJ_JOINT, j));
      ASSERT_GE(other, 0) << mj_id2name(a, mjOBJ_JOINT, j);
      ASSERT_EQ(a->jnt_limited[j], b->jnt_limited[other]) << mj_id2name(a, mjOBJ_JOINT, j);
      for (int end = 0; a->jnt_limited[j] && end < 2; ++end) {
        EXPECT_EQ(a->jnt_range[2 * j + end], b->jnt_range[2 * other + end]);
      }
      if (a->jnt_type[j] == mjJNT_FREE) continue;
      const double q = rng.uniform(-2, 2);
      da->qpos[a->jnt_qposadr[j]] = q;
      db->qpos[b->jnt_qposadr[other]] = q;
    }
    mj_kinematics(a, da.get());
    mj_kinematics(b, db.get());
    const auto expect_frame = [&](const double* p, const double* R, const char* name) {
      const int site = id(mjOBJ_SITE, name);
      const int body = id(mjOBJ_BODY, name);
      ASSERT_TRUE(site >= 0 || body >= 0) << name;
      const double* p2 = site >= 0 ? db->site_xpos + 3 * site : db->xpos + 3 * body;
      const double* R2 = site >= 0 ? db->site_xmat + 9 * site : db->xmat + 9 * body;
      EXPECT_LT((Eigen::Vector3d(p) - Eigen::Vector3d(p2)).norm(), 1e-9) << name;
      EXPECT_LT((RowMatrix(R) - RowMatrix(R2)).norm(), 1e-9) << name;
    };
    for (int i = 1; i < a->nbody; ++i) {
      expect_frame(da->xpos + 3 * i, da->xmat + 9 * i, mj_id2name(a, mjOBJ_BODY, i));
    }
    for (int s = 0; s < a->nsite; ++s) {
      expect_frame(da->site_xpos + 3 * s, da->site_xmat + 9 * s, mj_id2name(a, mjOBJ_SITE, s));
    }
  }
}

/// Effort and speed limits of the arm, which the files say differently.
void expect_same_limits(const Model& a, const Model& b, const std::string& tip) {
  const auto arm_a = find_arm(a, {.tip = tip});
  const auto arm_b = find_arm(b, {.tip = tip});
  ASSERT_TRUE(arm_a && arm_b) << tip;
  EXPECT_EQ(arm_a->limits.lower, arm_b->limits.lower);
  EXPECT_EQ(arm_a->limits.upper, arm_b->limits.upper);
  EXPECT_EQ(arm_a->limits.velocity, arm_b->limits.velocity);
  EXPECT_EQ(arm_a->limits.torque, arm_b->limits.torque);
}

std::vector<std::filesystem::path> shipped_files() {
  std::vector<std::filesystem::path> files;
  for (const ShippedModel& model : shipped_models()) files.push_back(model.file);
  const auto folder = files.back().parent_path().parent_path();
  files.push_back(folder / "universal_robots_ur5e/ur5e.urdf");
  files.push_back(folder / "franka_emika_panda/panda.urdf");
  files.push_back(folder / "franka_emika_panda/panda_nohand.xml");
  return files;
}

TEST(Export, ShippedModelsComeBackFromMjcfToTheLastBit) {
  for (const auto& file : shipped_files()) {
    SCOPED_TRACE(file.filename());
    const TempFolder folder;
    const Model model = load(file);
    EXPECT_EQ(mjb(round_trip(model, ExportFormat::mjcf, folder, "out.xml")), mjb(model));
  }
}

TEST(Export, ShippedModelsComeBackFromUrdf) {
  for (const auto& file : shipped_files()) {
    SCOPED_TRACE(file);
    const TempFolder folder;
    const Model model = load(file);
    const Model again = round_trip(model, ExportFormat::urdf, folder, "out.urdf");
    expect_same(model, again, 1000);
    if (const auto arm = find_arm(model)) expect_same_limits(model, again, arm->tip);
  }
}

std::string words(const char* name, const Eigen::VectorXd& values) {
  std::string all = std::string(" ") + name + "=\"";
  char number[40];
  for (const double value : values) {
    std::snprintf(number, sizeof number, "%.17g ", value);
    all += number;
  }
  return all + "\"";
}

Eigen::Vector3d random_vector(double size, Rng& rng) {
  return {rng.uniform(-size, size), rng.uniform(-size, size), rng.uniform(-size, size)};
}

Eigen::Vector4d random_quat(Rng& rng) {
  Eigen::Vector4d q;
  for (double& x : q) x = rng.uniform(-1, 1);
  return q.normalized();
}

/// A body with up to three joints, an inertia, a site, and children.
std::string random_body(int& count, int max, Rng& rng) {
  const std::string n = std::to_string(count++);
  std::string xml = "<body name=\"b" + n + "\"" + words("pos", random_vector(0.3, rng)) +
                    words("quat", random_quat(rng)) + ">";
  const Eigen::Vector3d masses(rng.uniform(1, 1.5), rng.uniform(1, 1.5), rng.uniform(1, 1.5));
  xml += "<inertial" + words("pos", random_vector(0.1, rng)) + words("quat", random_quat(rng)) +
         words("mass", Eigen::VectorXd::Constant(1, rng.uniform(0.1, 5))) +
         words("diaginertia", 0.01 * masses) + "/>";
  const int joints = static_cast<int>(rng.uniform(0, 3.999));
  for (int j = 0; j < joints; ++j) {
    xml += "<joint name=\"j" + n + "_" + std::to_string(j) + "\" type=\"" +
           (rng.uniform() < 0.3 ? "slide" : "hinge") + "\"" + words("axis", random_vector(1, rng)) +
           words("pos", random_vector(0.1, rng)) +
           words("ref", Eigen::VectorXd::Constant(1, rng.uniform(-1, 1))) +
           words("range", Eigen::Vector2d(rng.uniform(-3, -1), rng.uniform(1, 3))) +
           (rng.uniform() < 0.2 ? " limited=\"false\"" : "") + "/>";
  }
  xml += "<geom type=\"box\"" + words("size", Eigen::Vector3d(0.01, 0.02, 0.03)) +
         words("pos", random_vector(0.1, rng)) + "/>";
  xml += "<site name=\"s" + n + "\"" + words("pos", random_vector(0.1, rng)) +
         words("quat", random_quat(rng)) + "/>";
  while (count < max && rng.uniform() < 0.7) xml += random_body(count, max, rng);
  return xml + "</body>";
}

TEST(Export, RandomTreesComeBack) {
  Rng rng(77);
  for (int round = 0; round < 60; ++round) {
    const TempFolder folder;
    int count = 0;
    std::string bodies = random_body(count, 12, rng);
    const Model model = load(
        folder.write("in.xml", "<mujoco model=\"random\"><compiler angle=\"radian\"/><worldbody>" +
                                   bodies + "</worldbody></mujoco>"));
    EXPECT_EQ(mjb(round_trip(model, ExportFormat::mjcf, folder, "out.xml")), mjb(model));
    expect_same(model, round_trip(model, ExportFormat::urdf, folder, "out.urdf"), 20);
  }
}

TEST(Export, FreeBodiesFloat) {
  const TempFolder folder;
  const Model model = load(folder.write("in.xml", R"(<mujoco><worldbody>
    <body name="base" pos="1 2 3" quat="0 1 0 0"><freejoint name="free"/>
      <geom size="0.1" mass="2"/>
      <body name="link" pos="0 0 0.1"><joint name="j"/><geom size="0.1" mass="1"/></body>
    </body></worldbody></mujoco>)"));
  const Model again = round_trip(model, ExportFormat::urdf, folder, "out.urdf");
  ASSERT_EQ(again.nq(), 8);
  expect_same(model, again, 10);
}

/// A tetrahedron that is not centred, as a binary STL file.
std::string tetrahedron() {
  const float corners[4][3] = {{0.1F, 0, 0}, {0.5F, 0, 0}, {0.1F, 0.3F, 0}, {0.1F, 0, 0.2F}};
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  std::string stl(80, ' ');
  const std::uint32_t count = 4;
  stl.append(reinterpret_cast<const char*>(&count), 4);
  for (const auto& face : faces) {
    stl.append(12, '\0');
    for (const int corner : face) stl.append(reinterpret_cast<const char*>(corners[corner]), 12);
    stl.append(2, '\0');
  }
  return stl;
}

/// Where the vertices of the first mesh geom stand in the world.
std::vector<Eigen::Vector3d> vertices(const Model& model) {
  const mjModel* m = model.raw();
  const Data d(mj_makeData(m), mj_deleteData);
  mj_kinematics(m, d.get());
  std::vector<Eigen::Vector3d> all;
  for (int g = 0; g < m->ngeom; ++g) {
    if (m->geom_type[g] != mjGEOM_MESH) continue;
    const int mesh = m->geom_dataid[g];
    for (int v = 0; v < m->mesh_vertnum[mesh]; ++v) {
      const float* p = m->mesh_vert + 3 * (m->mesh_vertadr[mesh] + v);
      all.push_back(Eigen::Vector3d(d->geom_xpos + 3 * g) +
                    RowMatrix(d->geom_xmat + 9 * g) * Eigen::Vector3d(p[0], p[1], p[2]));
    }
    break;
  }
  return all;
}

TEST(Export, MeshesStayInPlace) {
  const TempFolder folder;
  folder.write("in/meshes/t.stl", tetrahedron());
  const Model model = load(folder.write("in/in.xml", R"(<mujoco><compiler meshdir="meshes"/>
    <asset><mesh name="t" file="t.stl" scale="2 3 -1"/></asset><worldbody>
    <body name="b" pos="1 0 0" quat="1 1 0 0"><joint name="j"/>
      <geom type="mesh" mesh="t" pos="0 0.5 0" quat="1 0 1 0"/></body></worldbody></mujoco>)"));
  const auto expected = vertices(model);
  ASSERT_EQ(expected.size(), 4U);
  for (const auto& [format, name] : {std::pair(ExportFormat::mjcf, "in/out.xml"),
                                     std::pair(ExportFormat::urdf, "in/out.urdf")}) {
    const auto exported = export_model(model, format, folder.path() / "in");
    ASSERT_TRUE(exported) << exported.error().what;
    EXPECT_THAT(exported->content, HasSubstr("\"meshes/t.stl\""));
    const Model again = load(folder.write(name, exported->content));
    expect_same(model, again, 10);
    const auto got = vertices(again);
    ASSERT_EQ(got.size(), expected.size());
    for (std::size_t i = 0; i < got.size(); ++i) {
      EXPECT_LT((got[i] - expected[i]).norm(), 1e-6) << name << ' ' << i;
    }
  }
  const auto elsewhere = export_model(model, ExportFormat::mjcf, folder.path() / "elsewhere");
  ASSERT_TRUE(elsewhere) << elsewhere.error().what;
  EXPECT_THAT(elsewhere->content, HasSubstr((folder.path() / "in/meshes/t.stl").generic_string()));
  EXPECT_THAT(elsewhere->notes, ::testing::Contains(HasSubstr("stay where they are")));
}

TEST(Export, BinaryIsMujocosOwn) {
  const TempFolder folder;
  const Model model = load(find_model_file("panda").value());
  const auto file = folder.write("panda.mjb", mjb(model));
  mjModel* again = mj_loadModel(file.string().c_str(), nullptr);
  ASSERT_NE(again, nullptr);
  EXPECT_EQ(again->nq, model.nq());
  mj_deleteModel(again);
}

TEST(Export, UrdfNamesWhatItCannotSay) {
  const auto exported =
      export_model(load(find_model_file("panda").value()), ExportFormat::urdf, "/");
  ASSERT_TRUE(exported) << exported.error().what;
  ASSERT_FALSE(exported->notes.empty());
  EXPECT_THAT(exported->notes[0], HasSubstr("actuator 8, tendon 1, equality 1"));

  const TempFolder folder;
  const Model ball = load(folder.write("ball.xml", R"(<mujoco><worldbody><body name="b">
    <joint name="round" type="ball"/><geom size="1"/></body></worldbody></mujoco>)"));
  const auto refused = export_model(ball, ExportFormat::urdf, "/");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::impossible);
  EXPECT_THAT(refused.error().what, HasSubstr("\"round\""));
}

TEST(Export, FormatsByName) {
  EXPECT_EQ(export_format("urdf").value(), ExportFormat::urdf);
  const auto unknown = export_format("udrf");
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().what, HasSubstr("\"urdf\""));
}

}  // namespace
}  // namespace mjarm
