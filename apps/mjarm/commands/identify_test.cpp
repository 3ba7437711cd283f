// `mjarm identify` on logs that `mjarm run` made, and `run --payload`.
#include <gmock/gmock.h>

#include <cmath>
#include <string>

#include "apps/mjarm/commands/program_test.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// Runs a shipped program into a folder; the path of its log.
std::string run_log(const support::TempFolder& folder, const std::string& name,
                    const std::string& program, const std::vector<std::string>& more) {
  const std::string out = (folder.path() / name).string();
  std::vector<std::string> words = {"run", program, "--headless", "--out", out};
  words.insert(words.end(), more.begin(), more.end());
  const auto result = mjarm(words);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return out + "/log.csv";
}

json identified(const std::vector<std::string>& more) {
  std::vector<std::string> words = {"identify", "--json"};
  words.insert(words.end(), more.begin(), more.end());
  const auto result = mjarm(words);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return json::parse(result.out, nullptr, false);
}

TEST(IdentifyCommand, FindsThePayloadOfARun) {
  const support::TempFolder folder;
  const std::string log = run_log(folder, "loaded", "excite", {"--payload", "1.5,10mm,-0.02,0.04"});
  const json payload = identified({log, "--robot", "ur5e"}).at("payload");
  EXPECT_TRUE(payload.at("told").get<bool>());
  EXPECT_NEAR(payload.at("mass").at("value").get<double>(), 1.5, 1e-3);
  const double center[] = {0.01, -0.02, 0.04};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(payload.at("com")[i].at("value").get<double>(), center[i], 1e-4);
  }
  const auto text = mjarm({"identify", log, "--robot", "ur5e"});
  EXPECT_THAT(text.out, HasSubstr("--payload 1.50"));
}

TEST(IdentifyCommand, FindsNoneWhereThereIsNone) {
  const support::TempFolder folder;
  const std::string log = run_log(folder, "empty", "excite_panda", {});
  const json all = identified({log, "--robot", "panda"});
  EXPECT_NEAR(all.at("payload").at("mass").at("value").get<double>(), 0, 1e-3);
  for (const json& joint : all.at("joints")) {
    EXPECT_NEAR(joint.at("viscous").at("value").get<double>(), 1, 0.01);  // the model's damping
    EXPECT_NEAR(joint.at("friction").at("value").get<double>(), 0, 0.01);
  }
  const json links = identified({log, "--robot", "panda", "--links"});
  EXPECT_FALSE(links.contains("payload"));
  int told = 0;
  for (const json& link : links.at("links")) {
    ASSERT_FALSE(link.at("estimate").is_null()) << link;
    EXPECT_NEAR(link.at("estimate").at("value").get<double>(), link.at("model").get<double>(), 5e-3)
        << link;
    ++told;
  }
  EXPECT_GT(told, 40);
}

TEST(IdentifyCommand, BadInputIsOneLineAndExitCodeTwo) {
  const support::TempFolder folder;
  const std::string log = run_log(folder, "still", "movej", {});
  const auto refused = [](const std::vector<std::string>& words) {
    const auto result = mjarm(words);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    return result.err;
  };
  EXPECT_THAT(refused({"identify", "--robot", "ur5e"}), HasSubstr("which log"));
  EXPECT_THAT(refused({"identify", "nothing.csv", "--robot", "ur5e"}), HasSubstr("nothing.csv"));
  EXPECT_THAT(refused({"identify", log, "--robot", "panda"}), HasSubstr("q joint1"));
  EXPECT_THAT(refused({"identify", log, "--robot", "ur5e", "--links", "--empty", log}),
              HasSubstr("--empty"));
  EXPECT_THAT(refused({"run", "movej", "--headless", "--payload", "-1"}), HasSubstr("--payload"));
  EXPECT_THAT(refused({"run", "movej", "--headless", "--payload", "1,2"}), HasSubstr("--payload"));
}

}  // namespace
}  // namespace mjarm::app
