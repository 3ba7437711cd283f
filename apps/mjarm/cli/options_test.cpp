// The reader of command lines, with a small program of its own, and the exit codes it gives.
#include "apps/mjarm/cli/options.hpp"

#include <gmock/gmock.h>

#include <array>
#include <stdexcept>

#include "apps/mjarm/cli/cli.hpp"

namespace mjarm::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr Msg kWord{"a word", "词"};
using Words = std::vector<std::string>;

/// What `tool saw` was given.
struct Given {
  std::string file, size, mode;
  Words parts;
  bool dry = false;
};

class Reader : public ::testing::Test {
 protected:
  void SetUp() override {
    program_ = make_program("tool", kWord, kWord);
    add_flag(*program_, "-v,--verbose", verbose_, kWord);
    CLI::App& saw = add_subcommand(*program_, "saw", kWord, kWord);
    add_option(saw, "file", given_.file, kWord, "FILE");
    add_option(saw, "--size", given_.size, kWord, "N");
    add_option(saw, "--mode", given_.mode, kWord, "MODE", "fast");
    add_option(saw, "--part", given_.parts, kWord, "NAME");
    add_flag(saw, "--dry", given_.dry, kWord);
    saw_ = &saw;
  }
  /// The one line of refusal; empty where the words are taken.
  std::string refusal(const Words& words) {
    const Result<bool> read = parse(*program_, words);
    if (read) return {};
    EXPECT_EQ(read.error().code, Errc::usage);
    return read.error().what;
  }

  Given given_;
  bool verbose_ = false;
  AppPtr program_;
  CLI::App* saw_ = nullptr;
};

TEST_F(Reader, ValuesMayStandBehindABlankOrAnEqualsSign) {
  ASSERT_EQ(refusal({"saw", "--size=a=b", "--part", "x,y", "--part=z", "log", "--dry"}), "");
  EXPECT_EQ(given_.size, "a=b");
  EXPECT_THAT(given_.parts, ElementsAre("x,y", "z"));
  EXPECT_EQ(given_.file, "log");
  EXPECT_TRUE(given_.dry);
  EXPECT_TRUE(is_called(*saw_));
  EXPECT_EQ(name_of(*saw_), "saw");
}

TEST_F(Reader, NumbersBelowZeroAreValues) {
  for (const char* value : {"-1", "-1,2,-3", "-90deg", "-1e-3", "-0.5,.5"}) {
    SetUp();
    given_ = {};
    ASSERT_EQ(refusal({"saw", "--size", value}), "") << value;
    EXPECT_EQ(given_.size, value);
  }
}

TEST_F(Reader, AnOptionThatMayStandBareHasItsOwnWord) {
  ASSERT_EQ(refusal({"saw", "--mode", "--size", "2"}), "");
  EXPECT_EQ(given_.mode, "fast");
  EXPECT_EQ(given_.size, "2");
  SetUp();
  ASSERT_EQ(refusal({"saw", "--mode", "slow"}), "");
  EXPECT_EQ(given_.mode, "slow");
  SetUp();
  given_ = {};
  ASSERT_EQ(refusal({"saw", "log"}), "");
  EXPECT_EQ(given_.mode, "");
}

TEST_F(Reader, AListTakesOneValueATime) {
  EXPECT_THAT(refusal({"saw", "--part", "a", "log", "b"}), HasSubstr("\"b\" is not expected"));
  EXPECT_THAT(given_.parts, ElementsAre("a"));
  EXPECT_EQ(given_.file, "log");
}

TEST_F(Reader, OptionsOfTheProgramMayFollowTheCommand) {
  ASSERT_EQ(refusal({"saw", "log", "-v"}), "");
  EXPECT_TRUE(verbose_);
  EXPECT_THAT(refusal({"--dry", "saw"}), HasSubstr("unknown option --dry"));
}

TEST_F(Reader, EachMistakeHasItsSentence) {
  const std::pair<Words, const char*> mistakes[] = {
      {{"saw", "--size"}, "--size needs a value"},
      {{"saw", "--size="}, "--size needs a value"},
      {{"saw", "--size", "1", "--size", "2"}, "--size may be given only once"},
      {{"saw", "--size=1", "--size=1"}, "--size may be given only once"},
      {{"saw", "--part"}, "--part needs a value"},
      {{"saw", "--sise=3"}, "unknown option --sise (did you mean \"--size\"?)"},
      {{"saw", "--verbos"}, "unknown option --verbos (did you mean \"--verbose\"?)"},
      {{"saw", "--helpp"}, "unknown option --helpp (did you mean \"--help\"?)"},
      {{"saw", "-x"}, "unknown option -x"},
      {{"saw", "log", "saw"}, "\"saw\" is not expected after \"tool saw\""},
      {{"swa"}, "unknown command \"swa\" after \"tool\" (did you mean \"saw\"?)"},
      {{"锯"}, "unknown command \"锯\" after \"tool\""}};
  for (const auto& [words, says] : mistakes) {
    SetUp();
    EXPECT_THAT(refusal(words), HasSubstr(says));
  }
}

TEST_F(Reader, HelpIsNoMistakeAndOfTheCommandThatWasCalled) {
  for (const Words& words : {Words{"saw", "--help"}, Words{"saw", "--size", "1", "-h"},
                             Words{"saw", "--help", "--nonsense"}}) {
    SetUp();
    const Result<bool> read = parse(*program_, words);
    ASSERT_TRUE(read) << read.error().what;
    EXPECT_FALSE(*read);
    const std::string help = help_of(*program_);
    EXPECT_THAT(help, HasSubstr("Usage: tool saw FILE [OPTIONS]\n"));
    for (const char* option : {"--size N", "--mode MODE", "--part NAME", "--dry", "-h, --help"}) {
      EXPECT_THAT(help, HasSubstr(std::string("\n  ") + option + " ")) << option;
    }
  }
}

TEST(CommandWord, IsTheFirstThatIsNeitherOptionNorLanguage) {
  EXPECT_EQ(command_word({"fk", "--lang", "en"}), 0U);
  EXPECT_EQ(command_word({"--quiet", "--lang", "en", "fk"}), 3U);
  EXPECT_EQ(command_word({"--lang=en", "fk"}), 1U);
  EXPECT_EQ(command_word({"--lang", "fk"}), 2U);  // its value: no command is left
  EXPECT_EQ(command_word({"--lang"}), 1U);        // never beyond the end
  EXPECT_EQ(command_word({"--help"}), 1U);
  EXPECT_EQ(command_word({}), 0U);
}

/// Words that make the command of the program below end in each way there is.
std::string end_word;

Run setup(CLI::App& app) {
  add_option(app, "--end", end_word, kWord, "HOW");
  return []() -> Result<int> {
    const std::pair<const char*, Errc> errors[] = {{"usage", Errc::usage},
                                                   {"bad_input", Errc::bad_input},
                                                   {"impossible", Errc::impossible},
                                                   {"not_available", Errc::not_available},
                                                   {"system", Errc::system}};
    for (const auto& [word, code] : errors) {
      if (end_word == word) return fail(code, "ended\nby " + end_word);
    }
    if (end_word == "throw") throw std::runtime_error("of its own");
    return end_word == "one" ? 1 : 0;
  };
}

/// Exit code and standard error of a program whose only command ends as it is told.
std::pair<int, std::string> run_ending(const std::string& how) {
  static constexpr std::array kEnding{Command{"end", kWord, kWord, setup}};
  end_word.clear();
  ::testing::internal::CaptureStderr();
  const int code = run(kEnding, {"end", "--end", how});
  return {code, ::testing::internal::GetCapturedStderr()};
}

TEST(ExitCodes, TellBadInputFromWhatCannotBeDone) {
  const std::pair<const char*, int> cases[] = {{"usage", 2},      {"bad_input", 2},
                                               {"impossible", 1}, {"not_available", 1},
                                               {"system", 1},     {"throw", 1}};
  for (const auto& [how, code] : cases) {
    const auto [exit_code, err] = run_ending(how);
    EXPECT_EQ(exit_code, code) << how;
    // One line, whatever the error holds.
    ASSERT_FALSE(err.empty());
    EXPECT_EQ(err.find('\n'), err.size() - 1) << err;
  }
  EXPECT_EQ(run_ending("throw").second, "internal error: of its own\n");
  EXPECT_EQ(run_ending("one"), std::pair(1, std::string()));
  EXPECT_EQ(run_ending("well"), std::pair(0, std::string()));
}

}  // namespace
}  // namespace mjarm::app
