#pragma once

#include <gtest/gtest.h>

#include "apps/mjarm/commands/program_test.hpp"
#include "mjarm/planning/two_problems_test.hpp"

namespace mjarm::app {

using testing::two_problems;

/// Runs `mjarm plan` on a file.
class PlanFile : public ::testing::Test {
 protected:
  std::string write(const nlohmann::json& file) {
    return folder_.write("problems.json", file.dump()).string();
  }
  support::ProgramResult plan(const nlohmann::json& file,
                              const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"plan", "--in", write(file)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return mjarm(arguments);
  }

  support::TempFolder folder_;
};

}  // namespace mjarm::app
