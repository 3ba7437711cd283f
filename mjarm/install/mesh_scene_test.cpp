#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <memory>

#include "mjarm/core/file.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/core/sha256.hpp"
#include "mjarm/install/mesh_scene_internal.hpp"
#include "mjarm/install/mesh_sets.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/model.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm::install {
namespace {

namespace fs = std::filesystem;

// Something with a volume: what is in the files does not matter to the physics.
constexpr const char* kTetrahedron =
    "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

fs::path shipped(const MeshSet& set) { return fs::path(MJARM_MODELS) / set.folder / "scene.xml"; }

struct FreeData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using Data = std::unique_ptr<mjData, FreeData>;

std::string name_of(const mjModel* m, mjtObj type, int id) {
  const char* name = mj_id2name(m, type, id);
  return name == nullptr ? "" : name;
}

bool touches(const mjModel* m, int geom) {
  return m->geom_contype[geom] != 0 || m->geom_conaffinity[geom] != 0;
}

/// The bodies that `meshes.xml` dresses are the robot's own; the floor and the target are not.
bool is_drawn_by_robot(const mjModel* m, int geom) {
  return m->geom_bodyid[geom] != 0 && m->geom_group[geom] == 2;
}

class MeshScene : public ::testing::TestWithParam<int> {
 protected:
  const MeshSet& set = mesh_sets()[static_cast<std::size_t>(GetParam())];

  void load_with(const std::function<void(const fs::path& assets)>& fill) {
    const fs::path place = folder.path() / "robot";
    fs::create_directories(place / "assets");
    fill(place / "assets");
    const Result<std::string> scene = mesh_scene(shipped(set));
    ASSERT_TRUE(scene) << scene.error().what;
    ASSERT_TRUE(write_file(place / "scene.xml", *scene));
    Result<Model> loaded = Model::load(place / "scene.xml");
    ASSERT_TRUE(loaded) << loaded.error().what;
    dressed.emplace(std::move(*loaded));
    plain.emplace(Model::load(shipped(set)).value());
  }
  void load_with_made_up_meshes() {
    load_with([&](const fs::path& assets) {
      for (const MeshFile& mesh : set.files) {
        if (!mesh.name.ends_with(".obj")) continue;
        ASSERT_TRUE(write_file(assets / mesh.name, kTetrahedron));
      }
    });
  }

  support::TempFolder folder;
  std::optional<Model> plain, dressed;
};

TEST_P(MeshScene, MeshesTakeThePlaceOfAllDrawnShapes) {
  ASSERT_NO_FATAL_FAILURE(load_with_made_up_meshes());
  const mjModel* m = dressed->raw();
  std::vector<bool> used(static_cast<std::size_t>(m->nmesh), false);
  for (int geom = 0; geom < m->ngeom; ++geom) {
    if (!is_drawn_by_robot(m, geom)) continue;
    EXPECT_EQ(m->geom_type[geom], mjGEOM_MESH);
    EXPECT_FALSE(touches(m, geom));
    EXPECT_GE(m->geom_matid[geom], 0);
    if (m->geom_dataid[geom] >= 0) used[static_cast<std::size_t>(m->geom_dataid[geom])] = true;
  }
  EXPECT_EQ(std::count(used.begin(), used.end(), false), 0);
}

TEST_P(MeshScene, ThePhysicsAreTheSameToTheLastBit) {
  ASSERT_NO_FATAL_FAILURE(load_with_made_up_meshes());
  const mjModel *a = plain->raw(), *b = dressed->raw();
  ASSERT_EQ(a->nbody, b->nbody);
  ASSERT_EQ(a->nq, b->nq);
  ASSERT_EQ(a->nv, b->nv);
  ASSERT_EQ(a->nu, b->nu);
  ASSERT_EQ(a->nsite, b->nsite);
  ASSERT_EQ(a->nM, b->nM);
  const Data da(mj_makeData(a)), db(mj_makeData(b));
  const auto same = [](const mjtNum* x, const mjtNum* y, std::size_t count) {
    return std::equal(x, x + count, y);
  };
  const auto nv = static_cast<std::size_t>(a->nv), nbody = static_cast<std::size_t>(a->nbody);
  Rng rng(11);
  for (int round = 0; round < 50; ++round) {
    mj_resetDataKeyframe(a, da.get(), 0);
    for (int i = 0; i < a->nq; ++i) da->qpos[i] += rng.uniform(-1, 1);
    for (int i = 0; i < a->nv; ++i) da->qvel[i] = rng.uniform(-1, 1);
    for (int i = 0; i < a->nu; ++i) da->ctrl[i] = rng.uniform(-1, 1);
    mj_copyState(a, da.get(), db.get(), mjSTATE_INTEGRATION);
    for (int step = 0; step < 20; ++step) {
      mj_step(a, da.get());
      mj_step(b, db.get());
    }
    ASSERT_TRUE(same(da->qpos, db->qpos, static_cast<std::size_t>(a->nq)));
    ASSERT_TRUE(same(da->qvel, db->qvel, nv));
    ASSERT_TRUE(same(da->xpos, db->xpos, 3 * nbody));
    ASSERT_TRUE(same(da->site_xpos, db->site_xpos, 3 * static_cast<std::size_t>(a->nsite)));
    ASSERT_TRUE(same(da->M, db->M, static_cast<std::size_t>(a->nC)));
    ASSERT_TRUE(same(da->qfrc_bias, db->qfrc_bias, nv));
    ASSERT_EQ(da->ncon, db->ncon);
  }
}

TEST_P(MeshScene, TheArmIsFoundAsBefore) {
  ASSERT_NO_FATAL_FAILURE(load_with_made_up_meshes());
  const Result<Arm> a = find_arm(*plain, {}), b = find_arm(*dressed, {});
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->dof(), b->dof());
  EXPECT_EQ(a->home, b->home);
  EXPECT_EQ(plain->name(), dressed->name());
}

struct Box {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e9), high = -low;
};

/// Box about what is drawn of each body, in the frame of the body.
std::vector<Box> drawn_boxes(const mjModel* m) {
  std::vector<Box> boxes(static_cast<std::size_t>(m->nbody));
  for (int geom = 0; geom < m->ngeom; ++geom) {
    if (!is_drawn_by_robot(m, geom)) continue;
    Box& box = boxes[static_cast<std::size_t>(m->geom_bodyid[geom])];
    mjtNum R[9];
    mju_quat2Mat(R, m->geom_quat + 4 * geom);
    const Eigen::Map<const Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor>> R_BG(R);
    const Eigen::Map<const Eigen::Vector3d> p_BG(m->geom_pos + 3 * geom);
    const auto add = [&](const Eigen::Vector3d& p_G) {
      const Eigen::Vector3d p_B = p_BG + R_BG * p_G;
      box.low = box.low.cwiseMin(p_B);
      box.high = box.high.cwiseMax(p_B);
    };
    if (m->geom_type[geom] == mjGEOM_MESH) {
      const int mesh = m->geom_dataid[geom];
      for (int v = m->mesh_vertadr[mesh]; v < m->mesh_vertadr[mesh] + m->mesh_vertnum[mesh]; ++v) {
        add(Eigen::Map<const Eigen::Vector3f>(m->mesh_vert + 3 * v).cast<double>());
      }
      continue;
    }
    const Eigen::Map<const Eigen::Vector3d> center(m->geom_aabb + 6 * geom),
        half(m->geom_aabb + 6 * geom + 3);
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      add(center + half.cwiseProduct(sign));
    }
  }
  return boxes;
}

TEST_P(MeshScene, RealMeshesLieWhereTheShapesAre) {
  MJARM_TEST_ARCHIVE(archive, "menagerie/" + set.folder + ".tar.xz");
  ASSERT_NO_FATAL_FAILURE(load_with([&](const fs::path& assets) {
    // Not from the wheel, but the same files: every mesh has the hash of our table.
    const support::TempFolder unpacked;
    support::unpack(archive, unpacked.path());
    for (const MeshFile& mesh : set.files) {
      const fs::path from = unpacked.path() / set.folder / "assets" / mesh.name;
      ASSERT_EQ(sha256_of_file(from).value_or(""), mesh.sha256) << from;
      fs::copy_file(from, assets / mesh.name);
    }
  }));
  const std::vector<Box> shapes = drawn_boxes(plain->raw()), meshes = drawn_boxes(dressed->raw());
  for (std::size_t body = 1; body < shapes.size(); ++body) {
    if (shapes[body].low.x() > shapes[body].high.x()) continue;
    const double low = (shapes[body].low - meshes[body].low).cwiseAbs().maxCoeff();
    const double high = (shapes[body].high - meshes[body].high).cwiseAbs().maxCoeff();
    const std::string name = name_of(plain->raw(), mjOBJ_BODY, static_cast<int>(body));
    // Our UR5e stands on a plate of 0.22 m, which is no part of the real one.
    EXPECT_LT(std::max(low, high), name == "base" ? 0.04 : 0.02) << name;
  }
}

std::string robot_of(const ::testing::TestParamInfo<int>& test) {
  return mesh_sets()[static_cast<std::size_t>(test.param)].robot;
}
INSTANTIATE_TEST_SUITE_P(Robots, MeshScene, ::testing::Values(0, 1), robot_of);

TEST(MeshSceneFaults, NameTheFile) {
  const support::TempFolder folder;
  const auto none = mesh_scene(folder.path() / "scene.xml");
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().what.find("scene.xml"), std::string::npos);
  const fs::path scene =
      folder.write("scene.xml", "<mujoco><include file=\"scene.xml\"/></mujoco>");
  folder.write("meshes.xml", "<mujocoinclude><body name=\"gone\"/></mujocoinclude>");
  EXPECT_FALSE(mesh_scene(scene));  // includes itself
  folder.write("scene.xml", "<mujoco><worldbody><body name=\"here\"/></worldbody></mujoco>");
  const auto gone = mesh_scene(scene);
  ASSERT_FALSE(gone);
  EXPECT_NE(gone.error().what.find("gone"), std::string::npos) << gone.error().what;
}

TEST(MeshSets, ListEveryMeshOnce) {
  constexpr std::uint64_t kWheel = 83622446;  // [bytes]
  std::size_t count = 0;
  for (const MeshSet& set : mesh_sets()) {
    for (const MeshFile& mesh : set.files) {
      EXPECT_EQ(mesh.sha256.size(), 64u);
      EXPECT_LE(mesh.offset + mesh.packed, kWheel);
      EXPECT_EQ(mesh.name.find('/'), std::string::npos);
      ++count;
    }
  }
  EXPECT_EQ(count, 87u);
}

}  // namespace
}  // namespace mjarm::install
