#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/run_program.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm::app {

/// Runs the built `mjarm` with these arguments.
inline support::ProgramResult mjarm(const std::vector<std::string>& arguments,
                                    const support::RunOptions& options = {}) {
  return support::run_program(MJARM_PROGRAM, arguments, options);
}

/// Path of a file of the shipped models.
inline std::string model_file(const std::string& name) {
  return std::string(MJARM_MODELS) + "/" + name;
}

/// The one line on standard error that goes with an exit code other than 0; checks that it is one.
inline std::string only_line(const support::ProgramResult& result) {
  const std::vector<std::string> lines = support::lines_of(result.err);
  EXPECT_EQ(lines.size(), 1u) << result.err;
  return lines.empty() ? std::string() : lines.front();
}

/// The JSON objects of a text, one a line; fails where a line is none.
inline std::vector<nlohmann::json> json_lines(const std::string& text) {
  std::vector<nlohmann::json> objects;
  for (const std::string& line : support::lines_of(text)) {
    nlohmann::json object = nlohmann::json::parse(line, nullptr, false);
    EXPECT_TRUE(object.is_object()) << line;
    objects.push_back(std::move(object));
  }
  return objects;
}

}  // namespace mjarm::app
