#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/support/run_program.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::app {
namespace {

support::ProgramResult serve(std::vector<std::string> arguments, const std::string& token = {}) {
  arguments.insert(arguments.begin(), "serve");
  return support::run_program(
      MJARM_PROGRAM, arguments,
      {.environment = {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}, {"MJARM_SERVE_TOKEN", token}}});
}

TEST(ServeCommand, RefusesWhatMakesNoSense) {
  const auto refused = [](const std::vector<std::string>& arguments, const char* part) {
    const support::ProgramResult result = serve(arguments);
    EXPECT_EQ(result.exit_code, 2) << part;
    EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    EXPECT_EQ(support::lines_of(result.err).size(), 1U) << result.err;
    EXPECT_TRUE(result.out.empty()) << result.out;
  };
  refused({}, "mjarm serve FILE");
  refused({"ur5"}, "ur5e");
  refused({"ur5e", "--port", "65536"}, "65535");
  refused({"ur5e", "--port", "-1"}, "--port");
  refused({"ur5e", "--port", "http"}, "--port");
  refused({"ur5e", "--seconds", "-1"}, "--seconds");
  refused({"ur5e", "--camera", "nose"}, "nose");
  const support::TempFolder folder;
  const std::string here = folder.path().string();
  refused({"--replay", here}, "--html");
  refused({"ur5e", "--replay", here}, "--replay");
  refused({"--replay", here, "--paused"}, "--replay");
  refused({"--replay", here + "/none.html"}, "none.html");
  refused({"--replay", folder.write("a.html", "<html>").string()}, "a.html");
  folder.write("b.html", "<html>");
  refused({"--replay", here}, "several");
}

/// The one line of a server that ran for a moment.
std::string address_of(const std::vector<std::string>& arguments) {
  const support::ProgramResult result = serve(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::vector<std::string> lines = support::lines_of(result.out);
  EXPECT_EQ(lines.size(), 1U) << result.out;
  return lines.empty() ? std::string() : lines.front();
}

TEST(ServeCommand, WithoutADisplayPrintsAnAddressThatIsNewEachTime) {
  const std::string first = address_of({"ur5e", "--seconds", "100ms"});
  EXPECT_TRUE(first.starts_with("http://127.0.0.1:")) << first;
  EXPECT_NE(first.find("Ctrl-C"), std::string::npos);
  const std::string address = first.substr(0, first.find(' '));
  EXPECT_EQ(address.size() - address.find('/', 7), 34U) << address;
  const std::string second = address_of({"car", "--seconds", "100ms", "--paused"});
  EXPECT_NE(second.substr(second.find('/', 7), 33), address.substr(address.find('/', 7), 33));
}

TEST(ServeCommand, IsAtTheSameAddressAgainWhereItsSecretIsGiven) {
  const std::string token = "00112233445566778899aabbccddeeff";
  const support::ProgramResult result = serve({"car", "--seconds", "100ms"}, token);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("/" + token + "/ "), std::string::npos) << result.out;
  for (const std::string& bad : {token.substr(1), token + "0", token.substr(1) + "A",
                                 token.substr(1) + "/", std::string("secret")}) {
    const support::ProgramResult refused = serve({"car", "--seconds", "100ms"}, bad);
    EXPECT_EQ(refused.exit_code, 2) << bad;
    EXPECT_NE(refused.err.find("MJARM_SERVE_TOKEN"), std::string::npos) << refused.err;
    EXPECT_EQ(refused.err.find(bad), std::string::npos) << "a secret is told";
    EXPECT_TRUE(refused.out.empty()) << refused.out;
  }
}

TEST(ServeCommand, ServesAProgramToo) {
  const support::TempFolder folder;
  const std::string program =
      folder.write("move.yaml", "robot: ur5e\nprogram:\n  - movej: {joints: home}\n").string();
  EXPECT_TRUE(address_of({program, "--seconds", "100ms"}).starts_with("http://127.0.0.1:"));
  const support::ProgramResult passive = serve({program, "--passive"});
  EXPECT_EQ(passive.exit_code, 2);
}

/// One file that is played without anybody; the folder it is in is enough to serve it.
TEST(ServeCommand, ARunIsRecordedAndServedAgain) {
  const support::TempFolder folder;
  const std::string html = (folder.path() / "kept" / "run.html").string();
  const std::string out = (folder.path() / "out").string();
  const auto run = support::run_program(
      MJARM_PROGRAM, {"run", "movel", "--headless", "--out", out, "--html", html});
  if (run.err.find("./dev page") != std::string::npos) GTEST_SKIP() << run.err;
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("run.html"), std::string::npos) << run.err;
  EXPECT_LT(folder.read("kept/run.html").size(), std::size_t{4} << 20);
  const std::string kept = (folder.path() / "kept").string();
  EXPECT_TRUE(address_of({"--replay", kept, "--seconds", "100ms"}).starts_with("http://127.0.0.1"));
  // The run itself is the same as without.
  const std::string plain = (folder.path() / "plain").string();
  ASSERT_EQ(
      support::run_program(MJARM_PROGRAM, {"run", "movel", "--headless", "--out", plain}).exit_code,
      0);
  EXPECT_EQ(folder.read("out/log.csv"), folder.read("plain/log.csv"));
}

TEST(ServeCommand, OptionsOfPagesThatWouldDoNothingAreRefused) {
  const auto refused = [](const std::vector<std::string>& arguments, const char* part) {
    const auto result = support::run_program(MJARM_PROGRAM, arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
  };
  refused({"run", "movel", "--serve", "--headless"}, "--headless");
  refused({"demo", "ellipse", "--port", "8000"}, "--serve");
  refused({"demo", "ellipse", "--html", "run.png"}, ".html");
  refused({"train", "reach", "--port", "8000"}, "--serve");
  refused({"plan", "--robot", "ur5e", "--goal", "0,0,0,0,0,0", "--html", "a.html", "--view"},
          "--html");
}

TEST(ServeCommand, WarnsWhereOthersGetIn) {
  const support::ProgramResult result =
      serve({"ur5e", "--seconds", "100ms", "--address", "0.0.0.0"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("0.0.0.0 lets everybody"), std::string::npos) << result.err;
  EXPECT_EQ(serve({"ur5e", "--address", "example.org"}).exit_code, 2);
}

}  // namespace
}  // namespace mjarm::app
