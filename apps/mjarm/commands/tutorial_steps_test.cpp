// Every command line of docs/tutorial_steps.md does what it does for its reader, step by step; the
// page in Chinese has the same ones.
#include <gmock/gmock.h>

#include <filesystem>

#include "apps/mjarm/commands/program_test.hpp"
#include "mjarm/core/os_child_input.hpp"

namespace mjarm::app {
namespace {

using Words = std::vector<std::string>;

/// Lines of the code of each step: between "```sh" and "```", under headings "## N. ...".
std::vector<Words> steps_of(const std::string& page) {
  std::vector<Words> steps;
  bool code = false;
  for (const std::string& line :
       support::lines_of(support::read_data(model_file("../docs/" + page)))) {
    if (line.starts_with("## ")) {
      EXPECT_EQ(line.substr(3, 2), std::to_string(steps.size() + 1) + ".") << line;
      steps.emplace_back();
    } else if (line.starts_with("```")) {
      code = line == "```sh";
    } else if (code) {
      steps.back().push_back(line);
    }
  }
  return steps;
}

/// What takes long is shortened for the test.
std::string shortened(std::string line) {
  if (line.starts_with("./dev train reach")) line += " --print-config";
  if (line.starts_with("./dev render")) line += " --size 160x90 --quality low";
  if (line.starts_with("./dev eval")) {
    const std::string trained = "first/best.safetensors";
    line.replace(line.find(trained), trained.size(), "models/policies/reach.safetensors");
    line += " --episodes 4";
  }
  return line;
}

/// A demo without options of its own: tests/demo_test.cpp runs them all.
bool is_plain_demo(const std::string& line) {
  return line.starts_with("./dev demo ") && line.find(" --") == std::string::npos;
}

class TutorialStep : public ::testing::TestWithParam<int> {};

TEST_P(TutorialStep, EveryCommandOfItRuns) {
  const std::vector<Words> steps = steps_of("tutorial_steps.md");
  ASSERT_EQ(steps.size(), 9U);
  const support::TempFolder folder;
  namespace fs = std::filesystem;
  fs::create_directory_symlink(fs::canonical(MJARM_MODELS), folder.path() / "models");
  const std::string program = folder.write("dev", "#!/bin/sh\nexec '" MJARM_PROGRAM "' \"$@\"\n");
  fs::permissions(program, fs::perms::owner_all);
  for (const std::string& line : steps[static_cast<std::size_t>(GetParam() - 1)]) {
    const bool films = line.find(".mp4") != std::string::npos;
    if (is_plain_demo(line) || (films && find_program("ffmpeg").empty())) continue;
    const auto result = support::run_program(
        "/bin/sh", {"-c", shortened(line)},
        {.folder = folder.path(), .input = {}, .environment = {{"DISPLAY", ""}}});
    EXPECT_EQ(result.exit_code, 0) << line << "\n" << result.out << result.err;
    EXPECT_EQ(result.err.find("error:"), std::string::npos) << line << "\n" << result.err;
  }
}

INSTANTIATE_TEST_SUITE_P(Tutorial, TutorialStep, ::testing::Range(1, 10),
                         [](const auto& step) { return "Step" + std::to_string(step.param); });

TEST(TutorialSteps, BothLanguagesHaveTheSameCommands) {
  EXPECT_EQ(steps_of("tutorial_steps.md"), steps_of("tutorial_steps.zh-CN.md"));
}

}  // namespace
}  // namespace mjarm::app
