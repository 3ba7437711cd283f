// Covers and meetings that come from the user's cache.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "mjarm/collision/cover.hpp"
#include "mjarm/collision/cover_cache_internal.hpp"
#include "mjarm/collision/fast_access_internal.hpp"
#include "mjarm/collision/fast_cache_internal.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/user_cache.hpp"
#include "mjarm/model/robot.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

namespace fs = std::filesystem;

constexpr double kCoarse = support::kSanitized ? 0.1 : 0.03;  // [m] quick to make

class CoverCache : public ::testing::Test {
 protected:
  CoverCache() {
    ::setenv("XDG_CACHE_HOME", folder_.path().string().c_str(), 1);
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
  const ModelCover without = cover(wall, {.bound = kCoarse});
  EXPECT_EQ(files().size(), 0U);
  ::setenv("MJARM_CACHE", "on", 1);
  expect_same(cover(wall, {.bound = kCoarse}), without);
  EXPECT_EQ(files().size(), 2U);  // spheres, and what meets what
  expect_same(cover(wall, {.bound = kCoarse}), without);
  EXPECT_EQ(files().size(), 2U);
  (void)cover("universal_robots_ur5e/scene.xml", {.bound = kCoarse});
  EXPECT_EQ(files().size(), 3U);
  (void)cover(wall, {.bound = 1.01 * kCoarse});
  EXPECT_EQ(files().size(), 4U);
  // Other rules are other meetings: the spheres stay.
  (void)cover(wall, {.bound = kCoarse, .rules = {.allowed = {{{"wall", "forearm_link"}}}}});
  EXPECT_EQ(files().size(), 5U);
}

/// Which spheres can meet is kept as well, and read with as much care.
TEST_F(CoverCache, KeepsTheTablesOfSpheresThatCanMeet) {
  const Arm arm = load_robot("universal_robots_ur5e/ur5e.xml").value().arm;
  ::setenv("MJARM_CACHE", "off", 1);
  const SphereSet set = cover("universal_robots_ur5e/ur5e.xml", {.bound = kCoarse}).spheres;
  const auto tables = [&](const SphereMargins& margins) {
    const FastRobot robot = FastRobot::create(arm, set, margins).value();
    return detail::bytes_of_pairs(detail::FastAccess::data(robot));
  };
  const std::string without = tables({}), wide = tables({0.01, 0.02});
  EXPECT_NE(without, wide);
  ::setenv("MJARM_CACHE", "on", 1);
  EXPECT_EQ(tables({}), without);
  EXPECT_EQ(files().size(), 1U);
  EXPECT_EQ(tables({}), without);
  EXPECT_EQ(tables({0.01, 0.02}), wide);  // with margins: not kept
  EXPECT_EQ(files().size(), 1U);

  const FastRobot robot = FastRobot::create(arm, set).value();
  const detail::FastRobotData& made = detail::FastAccess::data(robot);
  detail::FastRobotData data;
  data.arm = made.arm;
  data.groups = made.groups, data.parts = made.parts, data.spheres = made.spheres;
  ASSERT_TRUE(detail::read_pairs(without, data));
  EXPECT_EQ(detail::bytes_of_pairs(data), without);
  for (std::size_t size = 0; size < without.size(); size += 7) {
    EXPECT_FALSE(detail::read_pairs(without.substr(0, size), data)) << size;
  }
  data.spheres.pop_back();  // some partner is not there
  EXPECT_FALSE(detail::read_pairs(without, data));
  data.spheres = made.spheres;
  data.groups.pop_back();
  EXPECT_FALSE(detail::read_pairs(without, data));
}

/// What lies in the cache is what is taken; where it is of something else, or spoilt, it is made
/// anew.
TEST_F(CoverCache, IsReadWithCare) {
  const char* const scene = "universal_robots_ur5e/scene.xml";
  const ModelCover made = cover(scene, {.bound = kCoarse});
  for (const fs::path& file : files()) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << "nothing of ours";
  }
  expect_same(cover(scene, {.bound = kCoarse}), made);

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
