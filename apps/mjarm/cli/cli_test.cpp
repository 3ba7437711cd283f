#include "apps/mjarm/commands/program_test.hpp"

namespace mjarm::app {
namespace {

const std::vector<std::string> kCommands = {"doctor", "model", "fk", "ik"};

bool has_chinese(const std::string& text) {
  for (const char c : text) {
    if (static_cast<unsigned char>(c) >= 0xE3) return true;
  }
  return false;
}

TEST(CommandLine, VersionAndHelp) {
  const auto version = mjarm({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_EQ(version.out.rfind("mjarm ", 0), 0u);
  EXPECT_NE(version.out.find(" (MuJoCo "), std::string::npos) << version.out;
  EXPECT_EQ(version.err, "");
  for (const char* option : {"--help", "-h"}) {
    const auto help = mjarm({option});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_EQ(help.err, "");
    for (const std::string& command : kCommands) {
      EXPECT_NE(help.out.find("\n  " + command + " "), std::string::npos) << command;
    }
  }
}

TEST(CommandLine, EveryCommandHasHelpWithExamplesInBothLanguages) {
  std::vector<std::vector<std::string>> all = {{}, {"model", "info"}, {"model", "tree"}};
  for (const std::string& command : kCommands) all.push_back({command});
  for (std::vector<std::string> words : all) {
    words.push_back("--help");
    const auto english = mjarm(words);
    EXPECT_EQ(english.exit_code, 0);
    EXPECT_NE(english.out.find("Usage: mjarm"), std::string::npos);
    EXPECT_NE(english.out.find("Examples:\n  mjarm"), std::string::npos) << english.out;
    EXPECT_FALSE(has_chinese(english.out)) << english.out;
    words.insert(words.begin(), {"--lang", "zh-CN"});
    const auto chinese = mjarm(words);
    EXPECT_EQ(chinese.exit_code, 0);
    EXPECT_NE(chinese.out.find("用法：mjarm"), std::string::npos);
    EXPECT_NE(chinese.out.find("示例："), std::string::npos);
  }
}

TEST(CommandLine, LanguageComesFromTheOptionElseTheLocale) {
  support::RunOptions in_china;
  in_china.environment = {{"LANG", "zh_CN.UTF-8"}};
  EXPECT_TRUE(has_chinese(mjarm({"--help"}, in_china).out));
  EXPECT_TRUE(has_chinese(mjarm({"nonsense"}, in_china).err));
  EXPECT_FALSE(has_chinese(mjarm({"--help", "--lang", "en"}, in_china).out));
  EXPECT_FALSE(has_chinese(mjarm({"--lang=en", "nonsense"}, in_china).err));
  EXPECT_TRUE(has_chinese(mjarm({"nonsense", "--lang=zh-CN"}).err));
  const auto unknown = mjarm({"--lang", "zh-TV", "--help"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(only_line(unknown).find("did you mean \"zh-CN\"?"), std::string::npos);
}

TEST(CommandLine, HintsNameWhatTheUserTyped) {
  support::RunOptions by_dev;
  by_dev.environment = {{"MJARM_CALLED_AS", "./dev"}};
  const auto help = mjarm({"demo", "--help"}, by_dev);
  EXPECT_NE(help.out.find("Usage: ./dev demo "), std::string::npos) << help.out;
  EXPECT_NE(help.out.find("\n  ./dev demo ellipse\n"), std::string::npos) << help.out;
  EXPECT_EQ(help.out.find("mjarm demo"), std::string::npos) << help.out;
  EXPECT_NE(only_line(mjarm({"check"}, by_dev)).find("./dev check PROGRAM.yaml"),
            std::string::npos);
  EXPECT_NE(only_line(mjarm({"model", "inof"}, by_dev)).find("\"./dev model\""), std::string::npos);
  EXPECT_NE(only_line(mjarm({"models"}, by_dev)).find("./dev models"), std::string::npos);
  EXPECT_EQ(mjarm({"--version"}, by_dev).out.rfind("mjarm ", 0), 0u);
}

TEST(CommandLine, NoCommandIsAUsageError) {
  const auto none = mjarm({});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.out.find("Usage:"), std::string::npos);
  EXPECT_NE(only_line(none).find("--help"), std::string::npos);
}

struct Mistake {
  std::vector<std::string> arguments;
  std::string says;  ///< part of the one line
};

TEST(CommandLine, MistakesGiveOneLineAndTheNearestWord) {
  const std::vector<Mistake> mistakes = {
      {{"docter"}, "\"docter\" after \"mjarm\" (did you mean \"doctor\"?)"},
      {{"xyzzyxyzzy"}, "unknown command \"xyzzyxyzzy\""},
      {{"model", "inof"}, "(did you mean \"info\"?)"},
      {{"model"}, "info, tree"},
      {{"model", "info"}, "FILE is missing"},
      {{"model", "tree", "ur5e", "panda"}, "\"panda\" is not expected"},
      {{"fk", "--robto", "ur5e"}, "unknown option --robto (did you mean \"--robot\"?)"},
      {{"fk", "--robot=ur5e", "--qq=1"}, "unknown option --qq"},
      {{"fk", "--no-timing"}, "unknown option --no-timing"},
      {{"fk", "--robot"}, "--robot needs a value"},
      {{"fk", "--robot", "ur5e", "--robot", "panda"}, "--robot may be given only once"},
      {{"fk", "--q", "1"}, "--robot is missing"},
      {{"fk", "--robot", "ur5e"}, "exactly one of --in and --q"},
      {{"fk", "--robot", "ur5e", "--q", "1", "--in", "x"}, "exactly one of --in and --q"},
      {{"ik", "fk"}, "\"fk\" is not expected after \"mjarm ik\""},
      {{"--quiet", "--verbose", "doctor"}, "exclude each other"},
      {{"--vrebose", "doctor"}, "(did you mean \"--verbose\"?)"},
      {{""}, "unknown command \"\""},
      {{"doctor", std::string(5000, 'x')}, "is not expected"},
  };
  for (const Mistake& mistake : mistakes) {
    SCOPED_TRACE(mistake.says);
    const auto result = mjarm(mistake.arguments);
    EXPECT_EQ(result.exit_code, 2);
    const std::string line = only_line(result);
    EXPECT_NE(line.find(mistake.says), std::string::npos) << line;
    std::vector<std::string> chinese = mistake.arguments;
    chinese.push_back("--lang=zh-CN");
    const auto translated = mjarm(chinese);
    EXPECT_EQ(translated.exit_code, 2);
    EXPECT_TRUE(has_chinese(only_line(translated))) << translated.err;
  }
}

TEST(CommandLine, GlobalOptionsMayStandAnywhere) {
  const std::vector<std::string> q = {"--q", "0,0,0,0,0,0"};
  std::vector<std::string> before = {"--quiet", "fk", "--robot", "ur5e"};
  std::vector<std::string> after = {"fk", "--robot", "ur5e", "--quiet"};
  before.insert(before.end(), q.begin(), q.end());
  after.insert(after.end(), q.begin(), q.end());
  const auto first = mjarm(before);
  EXPECT_EQ(first.exit_code, 0) << first.err;
  EXPECT_EQ(first.out, mjarm(after).out);
}

TEST(CommandLine, OutputThatCannotBeWrittenIsAnError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const support::TempFolder folder;
  const auto result =
      support::run_program("/bin/sh", {"-c", std::string(MJARM_PROGRAM) + " --help > /dev/full"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(only_line(result).find("stdout: cannot be written: No space left"), std::string::npos);
}

}  // namespace
}  // namespace mjarm::app
