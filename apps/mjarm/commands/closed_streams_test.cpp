#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "apps/mjarm/commands/crane_test.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::app {
namespace {

using ::testing::HasSubstr;

support::ProgramResult in_shell(const std::string& command) {
  return support::run_program("/bin/sh", {"-c", "exec '" MJARM_PROGRAM "' " + command});
}

TEST(ClosedStreams, DoNotMakeAModelCrash) {
  const support::TempFolder folder;
  const std::string out = (folder.path() / "x.jsonl").string();
  const std::string crane = folder.write("crane.xml", kCrane).string();
  const std::string fk = "fk --robot '" + crane + "' --q 0.1,0.2,0.1 --out '" + out + "' ";
  for (const char* closed : {"", "<&-", ">&-", "<&- >&-", "2>&-", "<&- >&- 2>&-"}) {
    const auto result = in_shell(fk + closed);
    EXPECT_EQ(result.exit_code, 0) << closed << result.err;
    EXPECT_THAT(folder.read("x.jsonl"), HasSubstr("\"pos\"")) << closed;
    std::filesystem::remove(out);
  }
}

TEST(ClosedStreams, TakeNoMessagesIntoTheFilesOfATraining) {
  const support::TempFolder folder;
  const std::string config =
      folder
          .write("small.yaml",
                 "task: {environments: 8}\n"
                 "ppo: {rollout_steps: 16, minibatch: 64, epochs: 1, total_steps: 256, "
                 "actor: [8], critic: [8]}\n"
                 "training: {evaluate_every: 128, evaluate_episodes: 4}\n")
          .string();
  const auto train = [&](const std::string& out, const std::string& closed) {
    const auto result = in_shell("train reach --no-timing --config '" + config + "' --out '" +
                                 (folder.path() / out).string() + "' " + closed);
    EXPECT_EQ(result.exit_code, 0) << result.err;
  };
  train("open", "");
  train("closed", "<&- >&- 2>&-");
  for (const char* name : {"progress.csv", "events.out.tfevents.mjarm", "last.safetensors"}) {
    EXPECT_EQ(folder.read(std::string("closed/") + name), folder.read(std::string("open/") + name))
        << name;
  }
}

}  // namespace
}  // namespace mjarm::app
