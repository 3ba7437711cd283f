#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>

#include "mjarm/core/file.hpp"
#include "mjarm/core/stored_zip.hpp"
#include "mjarm/episode/dataset.hpp"
#include "mjarm/episode/draw_scene.hpp"
#include "mjarm/episode/episode_file.hpp"
#include "mjarm/episode/record.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::episode {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// Small and few pictures: what is looked at is the rest.
EpisodeOptions quick(const std::string& task) {
  return {.task = task, .robot = "panda", .seed = 5, .size = 16, .fps = 1};
}

/// The files of a folder, by their names.
std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> out;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    out[fs::relative(entry.path(), folder).generic_string()] = read_file(entry.path()).value();
  }
  return out;
}

std::string entry_of(const std::string& archive, const std::string& name) {
  return std::string(StoredZip::open(archive, "test").value().read_checked(name).value());
}

TEST(DrawScene, StaysWithinItsRangesAndApart) {
  const Robot robot = load_robot("franka_emika_panda/pick.xml").value();
  std::size_t targets = 0;
  for (std::uint64_t number = 0; number < 200; ++number) {
    const DrawnScene scene = draw_scene(robot, quick("pick_place"), number);
    ASSERT_EQ(scene.objects.size(), 3u);
    targets |= std::size_t{1} << scene.target;
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d& p = scene.objects[i].X_WB.p;
      EXPECT_TRUE(p.x() >= 0.36 && p.x() < 0.62 && p.y() >= 0.03 && p.y() < 0.32) << p;
      const DrawnObject& next = scene.objects[(i + 1) % 3];
      EXPECT_GE((p - next.X_WB.p).head<2>().norm(), 0.12);
      EXPECT_NE(scene.objects[i].color, next.color);
    }
    EXPECT_THAT(scene.english, HasSubstr(scene.objects[scene.target].color));
    EXPECT_THAT(scene.english, HasSubstr(scene.objects[scene.target].name));
  }
  EXPECT_EQ(targets, 7u) << "an object was never asked for";
}

TEST(Judge, KnowsWhatIsNotWhereItBelongs) {
  const Pose goal{.p = {0.5, -0.2, 0.236}};
  const std::vector<Pose> others{{.p = {0.4, 0.1, 0.23}}};
  EXPECT_TRUE(judge(goal, goal, others, others).success());
  const Pose off{.p = goal.p + Eigen::Vector3d(0, 0.006, 0)};
  EXPECT_EQ(judge(off, goal, others, others).reason, "off_goal");
  Pose turned = goal;
  turned.R = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()).toRotationMatrix();
  EXPECT_EQ(judge(turned, goal, others, others).reason, "off_goal");
  const std::vector<Pose> pushed{{.p = {0.4, 0.102, 0.23}}};
  EXPECT_EQ(judge(goal, goal, others, pushed).reason, "others_moved");
  EXPECT_NEAR(judge(goal, goal, others, pushed).others, 2e-3, 1e-12);
  const Pose nowhere{.p = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())};
  EXPECT_FALSE(judge(nowhere, goal, others, others).success());
}

TEST(Studio, MakesAnEpisodeFromItsNumberAlone) {
  Studio studio = Studio::open(quick("reach")).value();
  const std::string third = studio.make(3).value().bytes;
  const Episode other = studio.make(4).value();
  EXPECT_NE(other.bytes, third);
  Studio again = Studio::open(quick("reach")).value();
  EXPECT_EQ(again.make(3).value().bytes, third);
  EXPECT_EQ(again.model_hash(), studio.model_hash());
}

TEST(Studio, PicturesChangeNothingThatMoves) {
  EpisodeOptions large = quick("reach");
  large.size = 48;
  const std::string small = Studio::open(quick("reach")).value().make(0).value().bytes;
  const std::string big = Studio::open(large).value().make(0).value().bytes;
  EXPECT_EQ(entry_of(small, "qpos.npy"), entry_of(big, "qpos.npy"));
  EXPECT_NE(entry_of(small, "frames/front/000000.png"), entry_of(big, "frames/front/000000.png"));
}

/// The object ends in the tray by MuJoCo's own account: the last row of the archive.
TEST(Studio, PutsAnObjectIntoTheTray) {
  const EpisodeOptions options = quick("pick_place");
  Studio studio = Studio::open(options).value();
  const Robot robot = load_robot("franka_emika_panda/pick.xml").value();
  const Episode done = studio.make(0).value();
  EXPECT_EQ(done.verdict.reason, "");
  EXPECT_LT(done.verdict.position, kAtGoal);
  const std::string poses = entry_of(done.bytes, "object_poses.npy");
  const std::size_t target = draw_scene(robot, options, 0).target;
  double p[3];
  std::copy_n(poses.end() - 8 * 21 + static_cast<std::ptrdiff_t>(8 * 7 * target), sizeof p,
              reinterpret_cast<char*>(p));
  EXPECT_TRUE(p[0] > 0.37 && p[0] < 0.63 && p[1] > -0.42 && p[1] < -0.1) << p[0] << ' ' << p[1];
}

class Dataset : public ::testing::Test {
 protected:
  Result<DatasetOutcome> record(const std::string& name, DatasetOptions options) {
    return record_dataset(folder_.path() / name, options);
  }
  support::TempFolder folder_;
};

TEST_F(Dataset, HasTheSameBytesHoweverItWasMade) {
  const DatasetOptions three{.episode = quick("reach"), .episodes = 3};
  const auto one = record("one", three);
  ASSERT_TRUE(one) << one.error().what;
  EXPECT_EQ(one->made, 3u);
  DatasetOptions both = three;
  both.processes = 2;
  ASSERT_TRUE(record("two", both));
  EXPECT_EQ(contents(folder_.path() / "two"), contents(folder_.path() / "one"));

  // Stopped after the first, and gone on; what a killed process leaves is no episode.
  bool over = false;
  DatasetOptions cut = three;
  cut.stop = [&] { return over; };
  cut.after_episode = [&](const Episode&) { over = true; };
  const auto stopped = record("cut", cut);
  ASSERT_TRUE(stopped) << stopped.error().what;
  EXPECT_TRUE(stopped->stopped);
  EXPECT_EQ(stopped->made, 1u);
  const auto rest = record("cut", three);
  ASSERT_TRUE(rest) << rest.error().what;
  EXPECT_EQ(rest->found, 1u);
  EXPECT_EQ(rest->made, 2u);
  EXPECT_EQ(contents(folder_.path() / "cut"), contents(folder_.path() / "one"));
}

TEST_F(Dataset, RefusesAFolderOfOtherOptions) {
  ASSERT_TRUE(record("one", {.episode = quick("reach"), .episodes = 1}));
  EpisodeOptions other = quick("reach");
  other.seed = 6;
  const auto refused = record("one", {.episode = other, .episodes = 1});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::usage);
  EXPECT_THAT(refused.error().what, HasSubstr("--seed 5, not 6"));
}

TEST_F(Dataset, ReplayNoticesAChangedByte) {
  Studio studio = Studio::open(quick("reach")).value();
  const std::string bytes = studio.make(2).value().bytes;
  const auto file = folder_.write("episode_000002.zip", bytes);
  const EpisodeFile kept = read_episode(file).value();
  EXPECT_EQ(kept.head.number, 2u);
  EXPECT_EQ(replay(studio, kept, "e").value(), "");
  for (const char* name : {"qpos.npy", "frames/side/000000.png"}) {
    std::string changed = bytes;
    changed[changed.find(name) + std::string(name).size() + 40] ^= 1;
    const auto place = folder_.write("changed.zip", changed);
    EXPECT_EQ(replay(studio, read_episode(place).value(), "e").value(),
              std::string(name) + ", byte 41");
  }
}

/// What an archive with this `episode.json` is refused with.
std::string refusal(const support::TempFolder& folder, const std::string& json) {
  StoredZipWriter zip;
  zip.add("episode.json", json);
  const auto read = read_episode(folder.write("x.zip", std::move(zip).finish()));
  return read ? "" : read.error().what;
}

TEST_F(Dataset, RefusesHostileFiles) {
  const std::string good =
      R"({"schema":"mjarm.episode/1","task":"reach","robot":"panda","seed":1,"number":0,)"
      R"("size":16,"fps":1,"success":true,"reason":"","model_hash":"x"})";
  EXPECT_EQ(refusal(folder_, good), "");
  const auto with = [&](const std::string& before, const std::string& after) {
    std::string json = good;
    json.replace(json.find(before), before.size(), after);
    return refusal(folder_, json);
  };
  EXPECT_THAT(with("\"size\":16", "\"size\":100000"), HasSubstr("size has to be between 16 and"));
  EXPECT_THAT(with("\"size\":16", "\"size\":-1"), HasSubstr("size is missing or no 0..."));
  EXPECT_THAT(with("\"fps\":1", "\"fps\":1e300"), HasSubstr("fps is missing"));
  EXPECT_THAT(with("reach", "../../etc"), HasSubstr("no task is called"));
  EXPECT_THAT(with("panda", "pr2"), HasSubstr("there are panda, ur5e"));
  EXPECT_THAT(with("episode/1", "episode/9"), HasSubstr("mjarm.episode/1"));
  EXPECT_THAT(with("\"seed\":1,", ""), HasSubstr("seed is missing"));
  EXPECT_THAT(refusal(folder_, std::string(1000, '[')), HasSubstr("x.zip: episode.json"));
  EXPECT_THAT(read_episode(folder_.write("x.zip", "PK")).error().what, HasSubstr("x.zip"));
  EXPECT_FALSE(read_episode(folder_.path() / "none.zip"));
  const std::string bytes = Studio::open(quick("reach")).value().make(0).value().bytes;
  for (std::size_t size = 0; size < bytes.size(); size += bytes.size() / 50) {
    EXPECT_FALSE(read_episode(folder_.write("x.zip", bytes.substr(0, size)))) << size;
  }
}

}  // namespace
}  // namespace mjarm::episode
