#include "mjarm/episode/task_world.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <limits>
#include <span>

#include "mjarm/core/stored_zip.hpp"
#include "mjarm/render/png.hpp"

namespace mjarm::episode {
namespace {

EpisodeOptions world_options(const std::string& task, const std::string& robot = "panda") {
  return {.task = task, .robot = robot, .seed = 5, .size = 16, .fps = 10};
}

/// A column of an archive, row after row, as numpy would read it: after the line of its header.
std::vector<double> column_of(const std::string& archive, const std::string& name) {
  const StoredZip zip = StoredZip::open(archive, "test").value();
  const std::string_view entry = zip.read_checked(name + ".npy").value();
  const std::string_view numbers = entry.substr(entry.find('\n') + 1);
  std::vector<double> out(numbers.size() / sizeof(double));
  std::memcpy(out.data(), numbers.data(), numbers.size());
  return out;
}

class TaskWorldReplay : public ::testing::TestWithParam<EpisodeOptions> {};

/// What a perfect policy would do: the actions of an episode lead to where the episode ended.
TEST_P(TaskWorldReplay, ActionsOfAnEpisodeSucceed) {
  Studio studio = Studio::open(GetParam()).value();
  TaskWorld world = TaskWorld::open(GetParam()).value();
  const auto dof = static_cast<std::size_t>(world.robot().arm.dof());
  std::uint64_t number = 0;  // not every scene has a way
  Episode episode = studio.make(number).value();
  while (!episode.verdict.success() && number < 4) episode = studio.make(++number).value();
  ASSERT_EQ(episode.verdict.reason, "");
  const std::vector<double> actions = column_of(episode.bytes, "action_joint");
  const std::vector<double> tool = column_of(episode.bytes, "tool_pose");
  world.reset(number);
  EXPECT_FALSE(world.verdict().success());
  for (std::size_t row = 0; (row + 1) * (dof + 1) <= actions.size(); ++row) {
    const Eigen::Map<const Eigen::Vector3d> p(tool.data() + 7 * row);
    ASSERT_LT((world.row().X_WT.p - p).norm(), 5e-3) << row;
    ASSERT_TRUE(world.step(std::span(actions).subspan(row * (dof + 1), dof + 1)));
  }
  EXPECT_EQ(world.verdict().reason, "") << world.verdict().position;
}

INSTANTIATE_TEST_SUITE_P(Tasks, TaskWorldReplay,
                         ::testing::Values(world_options("reach"), world_options("pick_place"),
                                           world_options("pick_place", "ur5e")));

TEST(TaskWorld, ShowsWhatTheEpisodeShows) {
  Studio studio = Studio::open(world_options("reach")).value();
  TaskWorld world = TaskWorld::open(world_options("reach")).value();
  const std::string bytes = studio.make(3).value().bytes;
  world.reset(3);
  for (const std::string camera : {"front", "side"}) {
    const auto kept =
        StoredZip::open(bytes, "test").value().read_checked("frames/" + camera + "/000000.png");
    EXPECT_EQ(render::encode_png(world.picture(camera).value()).value(), kept.value());
  }
  EXPECT_EQ(world.picture("top").error().code, Errc::bad_input);
}

TEST(TaskWorld, WildActionsStayWithinTheLimits) {
  TaskWorld world = TaskWorld::open(world_options("reach")).value();
  const Arm& arm = world.robot().arm;
  const JointVec before = world.reference();
  std::vector<double> wild(static_cast<std::size_t>(arm.dof()) + 1, 1e300);
  ASSERT_TRUE(world.step(wild));
  const JointVec moved = (world.reference() - before).cwiseAbs();
  EXPECT_TRUE((moved.array() <= 0.1 * arm.limits.velocity.array() + 1e-9).all()) << moved;
  EXPECT_DOUBLE_EQ(world.row().grip, 1);
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(world.step(wild));
  EXPECT_TRUE((world.reference().array() <= arm.limits.upper.array()).all());
  EXPECT_FALSE(world.verdict().success());
  for (const double bad : {std::numeric_limits<double>::infinity(), std::nan("")}) {
    wild.back() = bad;
    EXPECT_EQ(world.step(wild).error().code, Errc::bad_input);
  }
  EXPECT_EQ(world.step({}).error().code, Errc::bad_input);
}

TEST(TaskWorld, IsTheSameAgain) {
  TaskWorld world = TaskWorld::open(world_options("pick_place")).value();
  std::vector<double> action(8, 0.1);
  const auto end = [&] {
    world.reset(4);
    for (int i = 0; i < 5; ++i) EXPECT_TRUE(world.step(action));
    return world.row().q;
  };
  const JointVec first = end();
  EXPECT_EQ(end(), first);
}

}  // namespace
}  // namespace mjarm::episode
