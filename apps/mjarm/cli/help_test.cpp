// The help of every command says what the command takes, and the same in both languages.
#include <gmock/gmock.h>

#include <algorithm>
#include <regex>
#include <set>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/commands/commands.hpp"
#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/text_width.hpp"
#include "tests/support/run_program.hpp"

namespace mjarm::app {
namespace {

using ::testing::HasSubstr;
using Words = std::vector<std::string>;

/// The program with all its commands, as the user has it but for the options of the program itself.
struct Whole {
  Whole() {
    for (const Command& command : commands()) {
      CLI::App& sub = add_subcommand(*app, command.name, command.summary, command.examples);
      if (command.setup != nullptr) runs.push_back(command.setup(sub));
    }
  }
  AppPtr app = make_program("mjarm", Msg{"summary", "概要"}, Msg{"", ""});
  std::vector<Run> runs;  ///< own what the options are bound to
};

std::string help_of_words(Words words, Language language = Language::english) {
  const LanguageScope scope(language);
  const Whole whole;
  words.emplace_back("--help");
  const Result<bool> read = parse(*whole.app, words);
  EXPECT_TRUE(read && !*read) << ::testing::PrintToString(words);
  return help_of(*whole.app);
}

/// Why a command line is refused.
std::string why_refused(const Words& words) {
  const Whole whole;
  const Result<bool> read = parse(*whole.app, words);
  EXPECT_FALSE(read) << ::testing::PrintToString(words);
  return read ? "" : read.error().what;
}

/// The lines between a heading and the next blank line.
Words section(const std::string& help, const std::string& heading) {
  const Words lines = support::lines_of(help);
  const auto begin = std::ranges::find(lines, heading);
  if (begin == lines.end()) return {};
  return {begin + 1, std::find(begin, lines.end(), "")};
}

/// An option as its line in the help tells it.
struct Told {
  std::string name;
  bool takes_value = false;
};

/// `  --out FILE  where ...`; blanks part what is written from what it means.
std::vector<Told> options_in(const Words& lines) {
  static const std::regex form(R"(^  (?:-\w, )?(--[a-z-]+)( \S.*?)?  +\S.*$)");
  std::vector<Told> out;
  std::smatch found;
  for (const std::string& line : lines) {
    if (std::regex_match(line, found, form)) out.push_back({found[1], found[2].length() > 0});
  }
  return out;
}

std::set<std::string> names_of(const std::vector<Told>& options) {
  std::set<std::string> names;
  for (const Told& option : options) names.insert(option.name);
  return names;
}

std::string first_word(const std::string& line) {
  const std::size_t begin = line.find_first_not_of(' ');
  return line.substr(begin, line.find(' ', begin) - begin);
}

/// Every command and what stands below it.
const std::vector<Words>& all_commands() {
  static const std::vector<Words> kAll = [] {
    std::vector<Words> all;
    for (const std::string& line : section(help_of_words({}), "Commands:")) {
      const std::string name = first_word(line);
      if (name == "bench") continue;  // another program does it
      all.push_back({name});
      for (const std::string& below : section(help_of_words({name}), "Commands:")) {
        all.push_back({name, first_word(below)});
      }
    }
    return all;
  }();
  return kAll;
}

TEST(Help, SaysOfEachOptionWhetherItTakesAValue) {
  for (const Words& command : all_commands()) {
    const std::vector<Told> options = options_in(section(help_of_words(command), "Options:"));
    EXPECT_TRUE(names_of(options).contains("--help"));
    for (const Told& option : options) {
      if (option.name == "--help" || option.name == "--torque") continue;  // may stand bare
      SCOPED_TRACE(::testing::PrintToString(command) + option.name);
      Words words = command;
      words.push_back(option.name);
      // A flag is taken, and what is refused then is a word that nothing knows.
      if (!option.takes_value) words.emplace_back("--no-such-option");
      EXPECT_THAT(why_refused(words), HasSubstr(option.takes_value ? option.name + " needs a value"
                                                                   : "option --no-such-option"));
    }
  }
}

TEST(Help, OfOptionsThatMayStandOnceSaysNothingOfMore) {
  for (const Words& command : all_commands()) {
    for (const std::string& line : section(help_of_words(command), "Options:")) {
      const std::vector<Told> told = options_in({line});
      if (told.empty() || !told.front().takes_value || told.front().name == "--torque") continue;
      Words words = command;
      for (int i = 0; i < 2; ++i) words.push_back(told.front().name + "=1");
      words.emplace_back("--no-such-option");
      const bool many = line.find("may be repeated") != std::string::npos;
      EXPECT_THAT(why_refused(words), HasSubstr(many ? "option --no-such-option" : "only once"))
          << line;
    }
  }
}

TEST(Help, IsTheSameInBothLanguages) {
  for (const Words& command : all_commands()) {
    SCOPED_TRACE(::testing::PrintToString(command));
    const std::string english = help_of_words(command);
    const std::string chinese = help_of_words(command, Language::chinese);
    EXPECT_EQ(names_of(options_in(section(english, "Options:"))),
              names_of(options_in(section(chinese, "选项："))));
    EXPECT_EQ(section(english, "Commands:").size(), section(chinese, "命令：").size());
    // Nothing is left in the other language, but for the one word that is a value.
    for (const std::string& line : section(chinese, "选项：")) {
      if (line.ends_with(" urscript")) continue;
      EXPECT_NE(line.find_first_of("\xE4\xE5\xE6\xE7\xE8\xE9", 0), std::string::npos) << line;
    }
  }
}

/// Where the meaning of an option begins on a terminal.
int meaning_column(const std::string& line) {
  const std::size_t gap = line.find("  ", 2);
  return text_width(line.substr(0, line.find_first_not_of(' ', gap)));
}

TEST(Help, MeaningsStandInOneColumn) {
  for (const Words& command : all_commands()) {
    for (const auto& [language, heading] :
         {std::pair(Language::english, "Options:"), {Language::chinese, "选项："}}) {
      Words lines = section(help_of_words(command, language), heading);
      ASSERT_GE(lines.size(), 2U);
      lines.pop_back();  // points at the options of the program
      for (const std::string& line : lines) {
        EXPECT_EQ(meaning_column(line), meaning_column(lines.front())) << line;
      }
    }
  }
}

/// The examples of a help that call `mjarm`, each with the lines it goes on in and without what is
/// said beside it.
Words examples_in(const std::string& help) {
  Words out;
  bool mine = false;
  const Words lines = support::lines_of(help.substr(help.find("Examples:")));
  for (const std::string& line : lines) {
    const bool begins = line.starts_with("  ") && !line.starts_with("   ");
    if (begins) mine = line.starts_with("  mjarm ");
    if (begins && mine) out.emplace_back();
    if (mine) out.back() += line.substr(0, line.find("   ", 8)) + " ";
  }
  return out;
}

TEST(Help, ExamplesUseOnlyCommandsAndOptionsThatAreThere) {
  static const std::regex option(R"(\s(--[a-z][a-z-]*))");
  const std::set<std::string> of_the_program{"--help", "--lang", "--quiet", "--verbose"};
  std::size_t looked_at = 0;
  for (const Words& command : all_commands()) {
    for (const std::string& line : examples_in(help_of_words(command))) {
      // The longest command that the example begins with.
      const Words* called = nullptr;
      for (const Words& known : all_commands()) {
        std::string words = "  mjarm";
        for (const std::string& word : known) words += " " + word;
        if (line.starts_with(words + " ") && (!called || known.size() > called->size())) {
          called = &known;
        }
      }
      ASSERT_NE(called, nullptr) << line;
      const auto known = names_of(options_in(section(help_of_words(*called), "Options:")));
      for (std::sregex_iterator it(line.begin(), line.end(), option), end; it != end; ++it) {
        ++looked_at;
        EXPECT_TRUE(known.contains((*it)[1]) || of_the_program.contains((*it)[1]))
            << (*it)[1] << " in " << line;
      }
    }
  }
  EXPECT_GT(looked_at, 60U);
}

TEST(Help, OfTheProgramNamesEveryCommandOnce) {
  const Words lines = section(help_of_words({}), "Commands:");
  for (const char* name :
       {"demo",  "doctor",    "model", "models", "fk",     "ik",      "path",   "plan",
        "time",  "verify",    "check", "run",    "export", "sim",     "render", "view",
        "serve", "workspace", "train", "eval",   "learn",  "identify"}) {
    const auto is_it = [&](const std::string& line) { return first_word(line) == name; };
    EXPECT_EQ(std::ranges::count_if(lines, is_it), 1) << name;
  }
}

}  // namespace
}  // namespace mjarm::app
