#pragma once

#include <string>
#include <utility>
#include <vector>

#include "apps/mjarm/commands/program_test.hpp"

namespace mjarm::app::testing {

/// Runs `mjarm learn check` on files in a folder of its own.
class LearnTest : public ::testing::Test {
 protected:
  support::ProgramResult run(const std::vector<std::string>& more) {
    std::vector<std::string> all{"learn"};
    all.insert(all.end(), more.begin(), more.end());
    support::RunOptions options;
    options.folder = folder_.path();
    options.environment = {{"PYTHONPATH", folder_.path().string()}};
    return mjarm(all, options);
  }
  support::ProgramResult check(const std::string& page, const std::string& file,
                               const std::vector<std::string>& more = {}) {
    std::vector<std::string> all{"check", page};
    if (!file.empty()) all.push_back(file);
    all.insert(all.end(), more.begin(), more.end());
    return run(all);
  }
  /// Writes the file first.
  support::ProgramResult check_text(const std::string& page, const std::string& name,
                                    const std::string& content,
                                    const std::vector<std::string>& more = {}) {
    folder_.write(name, content);
    return check(page, name, more);
  }

  /// That all is right, and that a line has `words`.
  static void expect_right(const support::ProgramResult& result, const std::string& words = "") {
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_NE(result.out.find(words), std::string::npos) << result.out;
    EXPECT_EQ(result.out.find("change  "), std::string::npos) << result.out;
  }
  /// That it is read, and that a line says `words` of what is to be changed.
  static void expect_wrong(const support::ProgramResult& result, const std::string& words) {
    EXPECT_EQ(result.exit_code, 1) << result.out << result.err;
    EXPECT_NE(only_line(result).find("not right yet"), std::string::npos) << result.err;
    bool told = false;
    for (const std::string& line : support::lines_of(result.out)) {
      told = told || (line.starts_with("change  ") && line.find(words) != std::string::npos);
    }
    EXPECT_TRUE(told) << words << " in " << result.out;
  }
  /// That it cannot be read, for which there is one line.
  static void expect_refused(const support::ProgramResult& result, const std::string& words) {
    EXPECT_EQ(result.exit_code, 2) << result.out << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_NE(only_line(result).find(words), std::string::npos) << result.err;
  }

  support::TempFolder folder_;
};

}  // namespace mjarm::app::testing
