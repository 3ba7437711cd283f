// `mjarm train`, `mjarm eval` and `mjarm demo reach`, as a user calls them.
#include <gmock/gmock.h>

#include <filesystem>

#include "apps/mjarm/commands/processes_test.hpp"
#include "apps/mjarm/commands/program_test.hpp"
#include "mjarm/core/os_child_input.hpp"
#include "tests/support/rounds.hpp"

namespace mjarm::app {
namespace {

using ::testing::HasSubstr;

/// A training of a second or so.
constexpr const char* kSmall =
    "task: {environments: 8}\n"
    "ppo: {rollout_steps: 16, minibatch: 64, epochs: 2, actor: [16], critic: [16], "
    "total_steps: 768}\n"
    "training: {evaluate_every: 256, evaluate_episodes: 4}\n";

std::string path_in(const support::TempFolder& folder, const std::string& name) {
  return (folder.path() / name).string();
}

/// The reason of a refusal: one line, exit code 2.
std::string refused(const std::vector<std::string>& arguments) {
  const auto result = mjarm(arguments);
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_EQ(result.out, "");
  return only_line(result);
}

TEST(Train, PrintedConfigurationsAreTakenAgain) {
  const support::TempFolder folder;
  const auto defaults = mjarm({"train", "reach", "--print-config"});
  ASSERT_EQ(defaults.exit_code, 0) << defaults.err;
  const auto file = folder.write("all.yaml", defaults.out).string();
  EXPECT_EQ(mjarm({"train", "reach", "--config", file, "--print-config"}).out, defaults.out);
  const auto other = mjarm({"train", "reach", "--config", file, "--region", "wide", "--orientation",
                            "--seed", "7", "--steps", "5000", "--print-config"});
  for (const char* line : {"region: wide", "orientation: true", "seed: 7", "total_steps: 5000"}) {
    EXPECT_THAT(other.out, HasSubstr(line));
  }
}

TEST(Train, AWiderRegionHasLongerEpisodes) {
  const auto steps = [](const std::string& region) {
    const auto shown = mjarm({"train", "reach", "--region", region, "--print-config"});
    EXPECT_EQ(shown.exit_code, 0) << shown.err;
    EXPECT_THAT(shown.out, HasSubstr("region: " + region));
    const std::size_t at = shown.out.find("episode_steps: ");
    return at == std::string::npos ? 0 : std::stoi(shown.out.substr(at + 15));
  };
  EXPECT_GT(steps("wide"), steps("tutorial"));
}

TEST(Train, FaultsOfAConfigurationAreOneLine) {
  const support::TempFolder folder;
  const auto fault = [&](const std::string& yaml) {
    return refused({"train", "reach", "--config", folder.write("f.yaml", yaml).string()});
  };
  EXPECT_THAT(fault("ppo: {learning_rat: 1}"), HasSubstr("f.yaml:1:7: \"learning_rat\""));
  EXPECT_THAT(fault("ppo: {learning_rat: 1}"), HasSubstr("learning_rate"));
  EXPECT_THAT(fault("pppo: {}"), HasSubstr("\"pppo\""));
  EXPECT_THAT(fault("ppo:\n  epochs: 1.5"), HasSubstr("f.yaml:2:11: epochs: expected a whole"));
  EXPECT_THAT(fault("ppo:\n  epochs: -1"), HasSubstr("epochs"));
  EXPECT_THAT(fault("ppo: {actor: 3}"), HasSubstr("actor: expected a list"));
  EXPECT_THAT(fault("ppo: {learning_rate: nan}"), HasSubstr("learning_rate: expected a number"));
  EXPECT_THAT(fault("task: {region: wid}"), HasSubstr("tutorial, wide"));
  EXPECT_THAT(fault("task: {environments: 99999999999}"), HasSubstr("environments"));
  EXPECT_THAT(fault("task: 3"), HasSubstr("f.yaml:1"));
  EXPECT_THAT(fault("- 1"), HasSubstr("task, reward, ppo, training"));
  EXPECT_THAT(fault("task: {"), HasSubstr("f.yaml:1"));
}

TEST(Train, FaultsOfTheCommandLineAreOneLine) {
  EXPECT_THAT(refused({"train"}), HasSubstr("mjarm train reach"));
  EXPECT_THAT(refused({"train", "raech"}), HasSubstr("did you mean \"reach\""));
  EXPECT_THAT(refused({"train", "reach", "--region", "wode"}), HasSubstr("wide"));
  EXPECT_THAT(refused({"train", "reach", "--seeds", "0"}), HasSubstr("--seeds"));
  EXPECT_THAT(refused({"train", "reach", "--config", "none.yaml"}), HasSubstr("none.yaml"));
  EXPECT_THAT(refused({"train", "reach", "--resume", "none.safetensors"}),
              HasSubstr("none.safetensors"));
  EXPECT_THAT(refused({"eval"}), HasSubstr("mjarm eval POLICY"));
  EXPECT_THAT(refused({"eval", "none.safetensors"}), HasSubstr("none.safetensors"));
  EXPECT_THAT(refused({"eval", "x.zip", "--episodes", "0"}), HasSubstr("--episodes"));
}

TEST(Train, LeavesAPolicyThatEvalTries) {
  const support::TempFolder folder;
  const auto config = folder.write("small.yaml", kSmall).string();
  const auto trained =
      mjarm({"train", "reach", "--config", config, "--out", path_in(folder, "out")});
  ASSERT_EQ(trained.exit_code, 0) << trained.err;
  EXPECT_THAT(trained.out, HasSubstr("| 768 "));
  EXPECT_THAT(trained.err, HasSubstr("256 steps"));
  for (const char* name : {"last.safetensors", "best.safetensors", "progress.csv", "report.json",
                           "curve.png", "curve.svg", "events.out.tfevents.mjarm"}) {
    EXPECT_TRUE(folder.exists(std::string("out/") + name)) << name;
  }
  const auto report = support::load_json(folder.path() / "out" / "report.json");
  EXPECT_EQ(report.at("ok"), true);
  EXPECT_EQ(report.at("steps"), 768);
  EXPECT_EQ(report.at("within").size(), 4U);

  const auto tried =
      mjarm({"eval", path_in(folder, "out/best.safetensors"), "--episodes", "4", "--least-success",
             "0", "--out", path_in(folder, "tried"), "--no-timing"});
  EXPECT_EQ(tried.exit_code, 0) << tried.err;
  EXPECT_THAT(tried.out, HasSubstr("within 2 cm"));
  const auto outcome = support::load_json(folder.path() / "tried" / "report.json");
  // The same goals as in training: the configuration went along.
  EXPECT_EQ(outcome.at("success"), report.at("success"));
  EXPECT_EQ(outcome.at("distance").at("median"), report.at("distance").at("median"));
  EXPECT_EQ(outcome.at("coverage"), outcome.at("success"));
  EXPECT_TRUE(outcome.contains("static_error"));
  EXPECT_GT(outcome.at("max_joint_step"), 0);
  for (const char* name : {"log.csv", "plot.png", "plot.svg"}) {
    EXPECT_TRUE(folder.exists(std::string("tried/") + name)) << name;
  }
  // Six episodes, each with its state before the first of 50 actions and after every 2 ms.
  EXPECT_EQ(support::lines_of(folder.read("tried/log.csv")).size(), 1U + 6U * (1 + 50 * 20));
}

TEST(Train, FilmsWhatWasLearned) {
  if (!testing::is_long()) GTEST_SKIP() << testing::kLongOnly;
  if (find_program("ffmpeg").empty()) GTEST_SKIP() << "no ffmpeg (apt-get install ffmpeg)";
  const support::TempFolder folder;
  std::string brief = kSmall;  // pictures take most of its time where the processor draws them
  brief.replace(brief.find("environments"), 0, "episode_steps: 8, ");
  const auto config = folder.write("brief.yaml", brief).string();
  const auto trained = mjarm({"train", "reach", "--config", config, "--steps", "256", "--video",
                              "--out", path_in(folder, "out")});
  EXPECT_EQ(trained.exit_code, 0) << trained.err;
  EXPECT_THAT(folder.read("out/result/video.mp4").substr(0, 12), HasSubstr("ftyp"));
  EXPECT_TRUE(folder.exists("out/result/report.json"));
}

TEST(Train, SeedsHaveFoldersOfTheirOwnAndATable) {
  const support::TempFolder folder;
  const auto config = folder.write("small.yaml", kSmall).string();
  const auto trained = mjarm({"train", "reach", "--config", config, "--seeds", "2", "--steps",
                              "256", "--out", path_in(folder, "out")});
  ASSERT_EQ(trained.exit_code, 0) << trained.err;
  EXPECT_THAT(trained.out, HasSubstr("| 1    |"));
  EXPECT_THAT(trained.out, HasSubstr("| 2    |"));
  EXPECT_NE(folder.read("out/seed-1/last.safetensors"), folder.read("out/seed-2/last.safetensors"));
}

/// Killed in the middle of whatever it did, it goes on as if nothing had happened.
TEST(Train, GoesOnAfterKill) {
  const support::TempFolder folder;
  const auto config = folder.write("small.yaml", kSmall).string();
  const auto train = [&](const std::string& out) {
    return std::vector<std::string>{"train",       "reach",   "--config",
                                    config,        "--steps", "4096",
                                    "--no-timing", "--out",   path_in(folder, out)};
  };
  ASSERT_EQ(mjarm(train("whole")).exit_code, 0);
  std::string script = "'" MJARM_PROGRAM "'";
  for (const std::string& word : train("killed")) script += " '" + word + "'";
  script += " & pid=$!; while [ ! -e '" + path_in(folder, "killed/best.safetensors") +
            "' ]; do sleep 0.01; done; kill -KILL $pid; wait $pid";
  EXPECT_NE(support::run_program("/bin/sh", {"-c", script}).exit_code, 0);
  const auto resumed = mjarm(
      {"train", "reach", "--resume", path_in(folder, "killed/last.safetensors"), "--no-timing"});
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  for (const char* name : {"last.safetensors", "best.safetensors", "progress.csv", "report.json",
                           "events.out.tfevents.mjarm"}) {
    EXPECT_EQ(folder.read(std::string("killed/") + name), folder.read(std::string("whole/") + name))
        << name;
  }
}

/// A file that may not grow beyond some size fails as a full disk does.
TEST(Train, AFullDiskIsOneLineAndKeepsTheCheckpoint) {
  const support::TempFolder folder;
  const auto config = folder.write("small.yaml", kSmall).string();
  const std::string out = path_in(folder, "out"), last = out + "/last.safetensors";
  const auto begun = mjarm({"train", "reach", "--config", config, "--steps", "256", "--out", out});
  ASSERT_EQ(begun.exit_code, 0) << begun.err;
  const std::string before = folder.read("out/last.safetensors");
  const std::string script = "trap '' XFSZ; ulimit -f 8; exec '" MJARM_PROGRAM
                             "' train reach --resume '" +
                             last + "' --steps 512";
  const auto result = support::run_program("/bin/sh", {"-c", script});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("last.safetensors"));
  EXPECT_EQ(folder.read("out/last.safetensors"), before);
  for (const auto& entry : std::filesystem::directory_iterator(out)) {
    EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
  }
  const auto resumed = mjarm({"train", "reach", "--resume", last, "--steps", "512"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
}

TEST(Train, CtrlCLeavesACheckpointThatGoesOn) {
  const support::TempFolder folder;
  const auto config = folder.write("small.yaml", kSmall).string();
  const std::string out = path_in(folder, "out");
  const std::string script = "'" MJARM_PROGRAM "' train reach --steps 100000000 --config '" +
                             config + "' --out '" + out + "' & pid=$!; while [ ! -e '" + out +
                             "/last.safetensors' ]; do sleep 0.01; done; kill -INT $pid; wait $pid";
  const auto stopped = support::run_program("/bin/sh", {"-c", script});
  EXPECT_EQ(stopped.exit_code, 1);
  EXPECT_THAT(stopped.err, HasSubstr("--resume"));
  EXPECT_EQ(support::load_json(folder.path() / "out" / "report.json").at("ok"), false);
  const auto resumed = mjarm({"train", "reach", "--resume", out + "/last.safetensors", "--steps",
                              "1", "--out", path_in(folder, "other")});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
}

#ifdef MJARM_MPIRUN
TEST(TrainInProcesses, OneIsTheSameAsNoneAndTwoShareTheWork) {
  const support::TempFolder folder;
  const auto config = folder.write("small.yaml", kSmall).string();
  const auto train = [&](const std::string& out, const std::string& steps) {
    return std::vector<std::string>{
        "train", "reach", "--config",           config,       "--steps", steps, "--threads",
        "1",     "--out", path_in(folder, out), "--no-timing"};
  };
  ASSERT_EQ(mjarm(train("alone", "768")).exit_code, 0);
  const auto one = in_processes(1, train("one", "768"));
  ASSERT_EQ(one.exit_code, 0) << one.err;
  EXPECT_EQ(folder.read("one/last.safetensors"), folder.read("alone/last.safetensors"));

  const auto two = in_processes(2, train("two", "1536"));
  ASSERT_EQ(two.exit_code, 0) << two.err;
  EXPECT_TRUE(folder.exists("two/last.rank1.safetensors"));
  EXPECT_EQ(support::load_json(folder.path() / "two" / "report.json").at("steps"), 1536);
  // Goes on in both, from the checkpoint of each.
  auto resume = train("two", "2048");
  resume[2] = "--resume";
  resume[3] = path_in(folder, "two/last.safetensors");
  const auto resumed = in_processes(2, resume);
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_THAT(resumed.err, HasSubstr("going on after 1536 steps"));
}

/// No process waits for one that cannot begin or go on.
TEST(TrainInProcesses, OneThatFailsTakesTheOthersAlong) {
  const support::TempFolder folder;
  const auto config = folder.write("small.yaml", kSmall).string();
  const std::string out = path_in(folder, "out"), last = out + "/last.safetensors";
  const auto begun = in_processes(2, {"train", "reach", "--config", config, "--out", out});
  ASSERT_EQ(begun.exit_code, 0) << begun.err;
  std::filesystem::rename(out + "/last.rank1.safetensors", out + "/moved");
  const auto missing = in_processes(2, {"train", "reach", "--resume", last, "--steps", "4096"});
  EXPECT_NE(missing.exit_code, 0);
  EXPECT_THAT(missing.err, HasSubstr("last.rank1.safetensors"));
  EXPECT_THAT(missing.err, HasSubstr("another of the processes"));
  // A folder stands in the way of a checkpoint that only the second process writes.
  std::filesystem::create_directories(path_in(folder, "other/last.rank1.safetensors/x"));
  const auto blocked =
      in_processes(2, {"train", "reach", "--config", config, "--out", path_in(folder, "other")});
  EXPECT_NE(blocked.exit_code, 0);
  EXPECT_THAT(blocked.err, HasSubstr("last.rank1.safetensors"));
}

#endif

TEST(Train, WhatIsNotReachedIsExitCodeOne) {
  const support::TempFolder folder;
  std::string strict = kSmall;
  strict.insert(strict.rfind('}'), ", stop_share: 0.95");
  const auto result = mjarm({"train", "reach", "--config", folder.write("s.yaml", strict).string(),
                             "--out", path_in(folder, "out")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("95 % within 20 mm"));
  EXPECT_EQ(support::load_json(folder.path() / "out" / "report.json").at("ok"), false);
}

TEST(Eval, TakesPoliciesOfStableBaselines) {
  const support::TempFolder folder;
  const std::string zips = MJARM_MODELS "/../mjarm/rl/testdata/";
  const auto tried = mjarm({"eval", zips + "sb3_guide.zip", "--task", "reach", "--guide",
                            "--episodes", "3", "--out", path_in(folder, "tried")});
  EXPECT_EQ(tried.exit_code, 1) << tried.out;
  EXPECT_THAT(tried.err, HasSubstr("3 of 3 goals were missed by 2 cm or more, 90 % must be met"));
  const auto report = support::load_json(folder.path() / "tried" / "report.json");
  EXPECT_EQ(report.at("success"), 0);  // untrained
  EXPECT_EQ(report.at("actions"), 2000);
  const std::string zip = zips + "sb3_tanh.zip";
  // It was made for other sizes: that is said, and not guessed round.
  EXPECT_THAT(refused({"eval", zip, "--task", "reach", "--guide", "--out", path_in(folder, "o")}),
              HasSubstr("sb3_tanh.zip"));
  EXPECT_THAT(refused({"eval", folder.write("broken.zip", "PK").string()}),
              HasSubstr("broken.zip"));
  EXPECT_THAT(refused({"eval", folder.write("broken.safetensors", "12345678").string()}),
              HasSubstr("broken.safetensors"));
}

TEST(Train, AnEarlierTrainingIsNotReplacedUnasked) {
  const support::TempFolder folder;
  const auto config = folder.write("small.yaml", kSmall).string();
  const std::vector<std::string> again{"train", "reach", "--config",
                                       config,  "--out", path_in(folder, "first")};
  ASSERT_EQ(mjarm(again).exit_code, 0);
  const auto best = folder.read("first/best.safetensors");
  const std::string told = refused(again);
  EXPECT_THAT(told, HasSubstr("best.safetensors"));
  EXPECT_THAT(told, HasSubstr("--resume"));
  EXPECT_THAT(told, HasSubstr("--overwrite"));
  EXPECT_EQ(folder.read("first/best.safetensors"), best);
  auto meant = again;
  meant.insert(meant.end(), {"--overwrite", "--seed", "5"});
  ASSERT_EQ(mjarm(meant).exit_code, 0);
  EXPECT_NE(folder.read("first/best.safetensors"), best);
}

}  // namespace
}  // namespace mjarm::app
