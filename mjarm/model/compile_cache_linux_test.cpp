// Compiled models that come from the user's cache.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "mjarm/core/file.hpp"
#include "mjarm/model/model.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

namespace fs = std::filesystem;

/// A tetrahedron of that size [m].
std::string wedge_stl(float size) {
  const std::array<std::array<float, 3>, 4> corners{
      {{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}}};
  std::string stl(80, ' ');
  const std::uint32_t count = 4;
  stl.append(reinterpret_cast<const char*>(&count), sizeof count);
  for (const auto& face :
       {std::array{0, 2, 1}, std::array{0, 1, 3}, std::array{0, 3, 2}, std::array{1, 2, 3}}) {
    stl.append(12, '\0');
    for (const int k : face) {
      stl.append(reinterpret_cast<const char*>(corners[static_cast<std::size_t>(k)].data()), 12);
    }
    stl.append(2, '\0');
  }
  return stl;
}

/// Of four meshes three decide about the model: as a contact, as a mass, and as a size.
constexpr const char* kScene = R"(<mujoco><asset>
    <mesh name="contact" file="contact.stl"/><mesh name="mass" file="mass.stl"/>
    <mesh name="size" file="size.stl"/><mesh name="looks" file="looks.stl"/></asset>
  <worldbody>
    <body name="a"><joint name="j"/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
      <geom type="mesh" mesh="contact"/>
      <geom type="mesh" mesh="looks" contype="0" conaffinity="0"/>
      <geom name="fitted" type="capsule" mesh="size"/></body>
    <body name="b"><joint name="k"/>
      <geom type="mesh" mesh="mass" contype="0" conaffinity="0"/></body>
  </worldbody>
  <keyframe><key name="home" qpos="0.25"/></keyframe></mujoco>)";

class CompileCacheTest : public ::testing::Test {
 protected:
  CompileCacheTest() {
    ::setenv("XDG_CACHE_HOME", (folder_.path() / "cache").string().c_str(), 1);
    ::setenv("MJARM_CACHE", "on", 1);
    scene_ = folder_.write("model/scene.xml", kScene);
    for (const char* name : {"contact", "mass", "size", "looks"}) write(name, 0.1F);
  }
  ~CompileCacheTest() override { ::setenv("MJARM_CACHE", "off", 1); }

  void write(const std::string& mesh, float size) {
    folder_.write("model/" + mesh + ".stl", wedge_stl(size));
  }
  std::vector<fs::path> kept() const {
    std::vector<fs::path> out;
    const fs::path folder = folder_.path() / "cache" / "mjarm";
    if (!fs::exists(folder)) return out;
    for (const auto& file : fs::directory_iterator(folder)) out.push_back(file);
    return out;
  }
  /// All of a model as bytes, with what MuJoCo says of the file.
  std::string loaded(bool looks = false) const {
    const Model model = Model::load(scene_, {.looks = looks}).value();
    std::string bytes(static_cast<std::size_t>(mj_sizeModel(model.raw())), '\0');
    mj_saveModel(model.raw(), nullptr, bytes.data(), static_cast<mjtSize>(bytes.size()));
    for (const std::string& warning : model.warnings()) bytes += warning;
    return bytes;
  }
  std::string made_anew() const {
    ::setenv("MJARM_CACHE", "off", 1);
    std::string out = loaded();
    ::setenv("MJARM_CACHE", "on", 1);
    return out;
  }

  support::TempFolder folder_;
  fs::path scene_;
};

TEST_F(CompileCacheTest, GivesTheSameUntilAFileThatMattersHasChanged) {
  const std::string before = made_anew();
  EXPECT_EQ(kept().size(), 0U);
  EXPECT_EQ(loaded(), before);
  ASSERT_EQ(kept().size(), 1U);
  const std::string entry = read_file(kept().front()).value();
  EXPECT_EQ(loaded(), before);
  EXPECT_EQ(read_file(kept().front()).value(), entry);  // nothing was made anew
  write("looks", 0.2F);  // MuJoCo may refuse it, so it gets to see it
  EXPECT_EQ(loaded(), before);
  EXPECT_NE(read_file(kept().front()).value(), entry);
  for (const char* mesh : {"contact", "mass", "size"}) {
    write(mesh, 0.2F);
    const std::string after = made_anew();
    EXPECT_NE(after, before) << mesh;
    EXPECT_EQ(loaded(), after) << mesh;
    write(mesh, 0.1F);
    EXPECT_EQ(loaded(), before) << mesh;
  }
  EXPECT_EQ(kept().size(), 1U);
  EXPECT_FALSE(loaded(true).empty());  // with looks: not kept
  EXPECT_EQ(kept().size(), 1U);
}

/// What lies in the cache is what is taken, but nothing that is no model.
TEST_F(CompileCacheTest, IsReadWithCare) {
  const std::string made = loaded();
  const fs::path file = kept().front();
  const std::string entry = read_file(file).value();
  for (const std::size_t size : {std::size_t{0}, std::size_t{70}, entry.size() / 2}) {
    ASSERT_TRUE(write_file(file, entry.substr(0, size)));
    EXPECT_EQ(loaded(), made) << size;
  }
  fs::remove(folder_.path() / "model" / "contact.stl");
  EXPECT_FALSE(Model::load(scene_, {.looks = false}));
}

}  // namespace
}  // namespace mjarm
