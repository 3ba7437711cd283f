// Every `plan` and `verify` that README and docs show is run as it stands there.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>

#include "apps/mjarm/commands/program_test.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;

const std::filesystem::path kRoot = std::filesystem::path(MJARM_MODELS).parent_path();
constexpr const char* kPublic = "mbm_panda_public.json.gz";

/// The arguments of all commands `./dev plan` and `./dev verify` of a page, in its order.
std::vector<std::vector<std::string>> commands_of(const std::string& page) {
  std::ifstream file(kRoot / page);
  std::string content(std::istreambuf_iterator<char>(file), {});
  for (std::size_t at = 0; (at = content.find("\\\n", at)) != std::string::npos;) {
    content.replace(at, 2, " ");
  }
  std::vector<std::vector<std::string>> out;
  for (std::size_t at = 0; (at = content.find("./dev ", at)) != std::string::npos;) {
    at += 6;
    std::istringstream words(content.substr(at, content.find_first_of("`#\n", at) - at));
    std::vector<std::string> command;
    for (std::string word; words >> std::quoted(word);) command.push_back(word);
    const bool shown = command.size() > 2 && (command[0] == "plan" || command[0] == "verify");
    if (shown && command[1] != "--help") out.push_back(std::move(command));
  }
  return out;
}

/// A folder in which the commands find what they name.
support::TempFolder& working_folder() {
  static support::TempFolder folder;
  static const bool kMade = [] {
    std::filesystem::create_directory_symlink(kRoot / "examples", folder.path() / "examples");
    const auto data = support::test_data_file(std::string("motionbenchmaker/") + kPublic);
    if (data && std::filesystem::exists(*data)) {
      std::filesystem::create_symlink(*data, folder.path() / kPublic);
    }
    return true;
  }();
  EXPECT_TRUE(kMade);
  return folder;
}

bool needs_data(const std::vector<std::string>& command) {
  const bool named = std::ranges::find(command, kPublic) != command.end();
  return named && !std::filesystem::exists(working_folder().path() / kPublic);
}

class DocumentedPlans : public ::testing::TestWithParam<const char*> {};

TEST_P(DocumentedPlans, Run) {
  const auto commands = commands_of(GetParam());
  EXPECT_FALSE(commands.empty());
  for (std::vector<std::string> command : commands) {
    if (needs_data(command)) continue;
    std::erase(command, "--view");  // has a test with a window of its own
    std::string line;
    for (const std::string& word : command) line += word + " ";
    const auto done = mjarm(command, {.folder = working_folder().path()});
    EXPECT_EQ(done.exit_code, 0) << line << done.err;
  }
}

INSTANTIATE_TEST_SUITE_P(Pages, DocumentedPlans,
                         ::testing::Values("README.md", "README.zh-CN.md", "docs/planning.md"));

/// What README shows as a path round something does go round it, and keeps what is preferred.
TEST(DocumentedPlan, OfReadmeGoesRoundTheWall) {
  std::vector<std::string> command = commands_of("README.md").at(0);
  EXPECT_EQ(command, commands_of("README.zh-CN.md").at(0));
  command.insert(command.end(), {"--out", "path.json"});
  const auto done = mjarm(command, {.folder = working_folder().path()});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const json path = json::parse(working_folder().read("path.json")).front();
  EXPECT_GT(path.at("path").size(), 2U);
  EXPECT_EQ(path.at("clearance"), 0.005);
  // Not the long way round the other side either.
  EXPECT_LT(path.at("cost").get<double>(), 5);
}

}  // namespace
}  // namespace mjarm::app
