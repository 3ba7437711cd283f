#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>

#include "mjarm/clone/cloned_policy.hpp"
#include "mjarm/clone/learn.hpp"
#include "mjarm/clone/trial.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/core/stored_zip.hpp"
#include "mjarm/episode/dataset.hpp"
#include "mjarm/episode/episode_file.hpp"
#include "mjarm/episode/read_column.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/jaws.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::clone {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

Pose somewhere(Rng& rng) {
  const auto vector = [&](double size) {
    return Eigen::Vector3d(size * rng.normal(), size * rng.normal(), size * rng.normal());
  };
  return {.p = vector(0.3), .R = rotation_exp(vector(1))};
}

Observed drawn(Rng& rng) {
  Observed out{.X_WT = somewhere(rng), .grip = 0.4, .objects = {}, .target = 1, .p_place = {}};
  for (int i = 0; i < 3; ++i) out.objects.push_back(somewhere(rng));
  out.p_place = somewhere(rng).p;
  return out;
}

std::vector<float> numbers_of(const Observed& seen) {
  std::vector<float> out(static_cast<std::size_t>(observation_size(seen.objects.size())));
  write_observation(seen, out);
  return out;
}

TEST(Observation, AnswersComeBackAsTheyWere) {
  Rng rng(1);
  for (int i = 0; i < 20; ++i) {
    const Observed seen = drawn(rng);
    const Answer answer{.X_WT = somewhere(rng), .grip = rng.uniform()};
    std::array<float, kActions> numbers;
    write_answer(seen, answer, numbers);
    const Answer back = read_answer(seen, numbers);
    EXPECT_NEAR((back.X_WT.p - answer.X_WT.p).norm(), 0, 1e-6);
    EXPECT_NEAR(angle_between(back.X_WT.R, answer.X_WT.R), 0, 1e-5);
    EXPECT_NEAR(back.grip, answer.grip, 1e-6);
  }
}

TEST(Observation, TellsWhatTheToolSees) {
  Rng rng(2);
  const Observed seen = drawn(rng);
  const std::vector<float> numbers = numbers_of(seen);
  const Eigen::Vector3d p_TB = seen.X_WT.R.transpose() * (seen.objects[1].p - seen.X_WT.p);
  const auto has = [&](double value) {
    return std::ranges::any_of(numbers, [&](float x) { return std::abs(x - value) < 1e-6; });
  };
  for (const double value : p_TB) EXPECT_TRUE(has(value));
  // Moved as a whole, about the tool nothing changes; in the world, its own pose does.
  const Pose X = somewhere(rng);
  Observed moved = seen;
  moved.X_WT = X * seen.X_WT;
  for (Pose& object : moved.objects) object = X * object;
  moved.p_place = X * seen.p_place;
  const std::vector<float> after = numbers_of(moved);
  int same = 0;
  for (std::size_t i = 0; i < after.size(); ++i) same += std::abs(after[i] - numbers[i]) < 1e-5;
  EXPECT_EQ(after.size() - static_cast<std::size_t>(same), 9u + 6u)
      << "the tool's pose in the world, and the way of the object to its place there";
}

TEST(Blurred, MovesTheToolAndWhatItHolds) {
  Rng rng(3);
  Shown row{.seen = drawn(rng), .answer = {}};
  row.seen.objects[1] = row.seen.X_WT * Pose{.p = {0, 0.01, 0.02}};
  row.answer.X_WT = somewhere(rng);
  int moved = 0;
  for (int i = 0; i < 50; ++i) {
    row.seen.grip = i % 2;
    const Shown out = blurred(row, rng);
    EXPECT_EQ(out.answer.X_WT.p, row.answer.X_WT.p);
    EXPECT_EQ(out.seen.objects[0].p, row.seen.objects[0].p);
    const double way = (out.seen.X_WT.p - row.seen.X_WT.p).norm();
    EXPECT_LT(way, 0.12);
    if (way == 0) continue;
    ++moved;
    const Pose X_TB = out.seen.X_WT.inverse() * out.seen.objects[1];
    const double slipped = (X_TB.p - Eigen::Vector3d(0, 0.01, 0.02)).norm();
    EXPECT_EQ(slipped < 1e-9, i % 2 == 1) << slipped;
  }
  EXPECT_GT(moved, 20);
}

/// An episode of small pictures.
class Recorded : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<support::TempFolder>();
    const episode::DatasetOptions options{
        .episode = {.task = "reach", .robot = "panda", .seed = 5, .size = 16, .fps = 5},
        .episodes = 1};
    ASSERT_TRUE(episode::record_dataset(data(), options));
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static fs::path data() { return folder_->path() / "data"; }

  static std::unique_ptr<support::TempFolder> folder_;
};
std::unique_ptr<support::TempFolder> Recorded::folder_;

TEST_F(Recorded, RowsAreWhatTheControllerWasTold) {
  const Result<Demonstrated> read = read_demonstrated(data(), 0);
  ASSERT_TRUE(read) << read.error().what;
  ASSERT_FALSE(read->numbers.empty());
  const fs::path file = data() / episode::episode_name(read->numbers.front());
  const episode::EpisodeFile kept = episode::read_episode(file).value();
  const StoredZip zip = StoredZip::open(kept.bytes, "test").value();
  const episode::Studio studio = episode::Studio::open(read->options).value();
  const Arm& arm = studio.robot().arm;
  const auto width = static_cast<std::size_t>(arm.dof());
  const auto told = episode::read_column(zip, "joint_reference", width, "test").value();
  ASSERT_GE(read->rows.size(), told.rows());
  for (std::size_t i = 1; i < told.rows(); ++i) {
    const Pose X_WT = fk(arm, told.row(i));
    EXPECT_NEAR((read->rows[i].seen.X_WT.p - X_WT.p).norm(), 0, 1e-9) << i;
    EXPECT_NEAR((read->rows[i - 1].answer.X_WT.p - X_WT.p).norm(), 0, 1e-9) << i;
  }
  const episode::DrawnScene scene =
      episode::draw_scene(studio.robot(), read->options, read->numbers.front());
  EXPECT_EQ(read->rows.front().seen.target, scene.target);
  EXPECT_NEAR(read->rows.front().seen.p_place.z() - scene.objects[scene.target].X_WB.p.z(), 0.12,
              1e-12);
}

TEST_F(Recorded, IsLearnedToTheSameBytesAndKept) {
  const Demonstrated data_read = read_demonstrated(data(), 0).value();
  rl::CloningOptions options{.hidden = {16}, .modes = 2, .batch = 32, .epochs = 3};
  const ClonedPolicy one = learn(data_read, options).value();
  options.threads = 2;
  EXPECT_EQ(learn(data_read, options).value().policy.tensors(), one.policy.tensors());
  const fs::path file = folder_->path() / "policy.safetensors";
  ASSERT_TRUE(save_cloned(file, one));
  const Result<ClonedPolicy> back = load_cloned(file);
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_EQ(back->policy.tensors(), one.policy.tensors());
  EXPECT_EQ(back->options.task, "reach");
  EXPECT_EQ(back->options.seed, 5u);
  EXPECT_EQ(back->options.fps, 5);
}

TEST_F(Recorded, TellsThatTheLearningDiverged) {
  const Demonstrated data_read = read_demonstrated(data(), 0).value();
  const Result<ClonedPolicy> learned = learn(
      data_read, {.hidden = {16}, .modes = 2, .batch = 32, .epochs = 9, .learning_rate = 1e30});
  ASSERT_FALSE(learned);
  EXPECT_EQ(learned.error().code, Errc::impossible);
  EXPECT_THAT(learned.error().what, HasSubstr("diverged in epoch"));
}

TEST_F(Recorded, RefusesOtherFilesInOneLine) {
  const support::TempFolder other;
  EXPECT_THAT(read_demonstrated(other.path(), 0).error().what, HasSubstr("holds no episodes"));
  const std::string name = episode::episode_name(read_demonstrated(data(), 1)->numbers.front());
  std::string bytes = read_file(data() / name).value();
  const std::size_t at = bytes.find("tool_pose.npy") + 13 + 128;  // in its numbers
  bytes[at] ^= 1;
  other.write(name, bytes);
  const auto damaged = read_demonstrated(other.path(), 0);
  ASSERT_FALSE(damaged);
  EXPECT_THAT(damaged.error().what, HasSubstr("tool_pose.npy"));
  EXPECT_FALSE(load_cloned(data() / name));
}

/// A policy that answers the same in every scene.
ClonedPolicy steady(const std::vector<float>& answer) {
  const int observations = observation_size(3);
  rl::Policy net(
      {observations, rl::MixturePolicy::outputs(kActions, 1), {}, {}, rl::Activation::relu});
  const std::size_t bias = net.blocks()[1].offset;
  for (std::size_t i = 0; i < answer.size(); ++i) net.parameters()[bias + i] = answer[i];
  return {rl::MixturePolicy(std::move(net), 1),
          {.task = "reach", .robot = "panda", .seed = 5, .size = 16, .fps = 5}};
}

TEST(TryPolicy, StandsStillWhereThePolicyDoesAndFailsForThat) {
  const auto trials = try_often(steady({}), 2, 2);
  ASSERT_TRUE(trials) << trials.error().what;
  for (const episode::Verdict& one : *trials) {
    EXPECT_EQ(one.reason, "off_goal");
    EXPECT_LT(one.others, 1e-3);
  }
  EXPECT_NE(trials->at(0).position, trials->at(1).position);
}

TEST(TryPolicy, LeadsTheToolAsThePolicyAnswers) {
  const ClonedPolicy up = steady({0, 0, -0.02F});  // 1 mm a row backwards along the tool's z
  episode::TaskWorld world = episode::TaskWorld::open(up.options).value();
  const auto verdict = try_policy(world, kFirstTrial, up.policy);
  ASSERT_TRUE(verdict) << verdict.error().what;
  const Robot& robot = world.robot();
  const Jaws jaws = find_jaws(robot.model, robot.arm).value();
  Pose X_WT = fk(robot.arm, world.scene().q);
  X_WT.p -= 0.1 * X_WT.R.col(2);  // after 20 s
  EXPECT_NEAR(verdict->position, (X_WT * jaws.center_T - *world.scene().p_goal).norm(), 1e-3);
}

TEST(TryPolicy, RefusesAPolicyOfAnotherSize) {
  ClonedPolicy wrong = steady({});
  wrong.policy = rl::MixturePolicy(rl::Policy({3, 8, {}, {}, rl::Activation::relu}), 1);
  const auto trials = try_often(wrong, 1, 1);
  ASSERT_FALSE(trials);
  EXPECT_THAT(trials.error().what, HasSubstr("3 observations"));
}

}  // namespace
}  // namespace mjarm::clone
