// Covers and meetings that come from the user's cache.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "mjarm/collision/cover.hpp"
#include "mjarm/collision/cover_cache_internal.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/user_cache.hpp"
#include "mjarm/model/robot.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

namespace fs = std::filesystem;

class CoverCache : public ::testing::Test {
 protected:
  CoverCache() {
    ::setenv("XDG_CACHE_HOME", folder_.path().c_str(), 1);
    ::setenv("MJARM_CACHE", "on", 1);
  }
  ~CoverCache() override { ::setenv("MJARM_CACHE", "off", 1); }

  std::vector<fs::path> files() const {
    std::vector<fs::path> out;
    if (!fs::exists(folder_.path() / "mjarm")) return out;
    for (const auto& file : fs::directory_iterator(folder_.path() / "mjarm")) out.push_back(file);
    return out;
  }
  static ModelCover cover(const char* robot, const CoverOptions& options = {}) {
    const Robot loaded = load_robot(robot).value();
    return cover_model(loaded.model, loaded.arm, options).value();
  }
  static void expect_same(const ModelCover& a, const ModelCover& b) {
    ASSERT_EQ(a.spheres.links.size(), b.spheres.links.size());
    for (std::size_t l = 0; l < a.spheres.links.size(); ++l) {
      const auto &one = a.spheres.links[l].spheres, &other = b.spheres.links[l].spheres;
      ASSERT_EQ(one.size(), other.size());
      for (std::size_t k = 0; k < one.size(); ++k) {
        EXPECT_EQ(one[k].center, other[k].center);
        EXPECT_EQ(one[k].radius, other[k].radius);
      }
    }
    EXPECT_EQ(a.bound, b.bound);
    EXPECT_EQ(a.spheres.pairs, b.spheres.pairs);
    EXPECT_EQ(a.pairs_apart, b.pairs_apart);
    ASSERT_EQ(a.scene.ignored.size(), b.scene.ignored.size());
    for (std::size_t k = 0; k < a.scene.ignored.size(); ++k) {
      EXPECT_EQ(a.scene.ignored[k].link, b.scene.ignored[k].link);
      EXPECT_EQ(a.scene.ignored[k].obstacle, b.scene.ignored[k].obstacle);
    }
  }
  support::TempFolder folder_;
};

TEST_F(CoverCache, GivesTheSameAndKeepsSpheresOnceForAllScenes) {
  const char* const wall = "universal_robots_ur5e/wall.xml";
  ::setenv("MJARM_CACHE", "off", 1);
  const ModelCover without = cover(wall, {.bound = 0.03});
  EXPECT_EQ(files().size(), 0U);
  ::setenv("MJARM_CACHE", "on", 1);
  expect_same(cover(wall, {.bound = 0.03}), without);
  EXPECT_EQ(files().size(), 2U);  // spheres, and what meets what
  expect_same(cover(wall, {.bound = 0.03}), without);
  EXPECT_EQ(files().size(), 2U);
  (void)cover("universal_robots_ur5e/scene.xml", {.bound = 0.03});
  EXPECT_EQ(files().size(), 3U);
  (void)cover(wall, {.bound = 0.031});
  EXPECT_EQ(files().size(), 4U);
  // Other rules are other meetings: the spheres stay.
  (void)cover(wall, {.bound = 0.03, .rules = {.allowed = {{{"wall", "forearm_link"}}}}});
  EXPECT_EQ(files().size(), 5U);
}

/// What lies in the cache is what is taken; where it is of something else, or spoilt, it is made
/// anew.
TEST_F(CoverCache, IsReadWithCare) {
  const char* const scene = "universal_robots_ur5e/scene.xml";
  const ModelCover made = cover(scene, {.bound = 0.03});
  for (const fs::path& file : files()) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << "nothing of ours";
  }
  expect_same(cover(scene, {.bound = 0.03}), made);

  const std::vector<detail::FittedCover> covers{{{{{1, 2, 3}, 0.5}, {{4, 5, 6}, 0.25}}, 0.01},
                                                {{{{7, 8, 9}, 0.125}}, 0.02}};
  const std::string bytes = detail::bytes_of(covers);
  const auto read = detail::covers_of(bytes, 2);
  ASSERT_TRUE(read);
  EXPECT_EQ((*read)[0].spheres[1].center, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ((*read)[1].bound, 0.02);
  EXPECT_FALSE(detail::covers_of(bytes, 1));
  EXPECT_FALSE(detail::covers_of(bytes, 3));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(detail::covers_of(bytes.substr(0, size), 2)) << size;
  }
  std::string long_list = bytes;
  long_list[8 + 7] = '\x7f';  // the highest byte of how many spheres there are
  EXPECT_FALSE(detail::covers_of(long_list, 2));

  detail::GeomGroups groups;
  groups.links.resize(3);
  groups.obstacles.resize(1);
  const detail::Meetings meetings{{{0, 2}, {1, 2}}, {{0, {1}}}, 5};
  const std::string words = detail::bytes_of(meetings);
  ASSERT_TRUE(detail::meetings_of(words, groups));
  EXPECT_EQ(detail::meetings_of(words, groups)->pairs, meetings.pairs);
  groups.links.resize(2);  // link 2 is not there
  EXPECT_FALSE(detail::meetings_of(words, groups));
}

}  // namespace
}  // namespace mjarm
