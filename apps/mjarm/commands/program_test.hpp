#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/rotation.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm::app {

/// Runs the built `mjarm` with these arguments.
inline support::ProgramResult mjarm(const std::vector<std::string>& arguments,
                                    const support::RunOptions& options = {}) {
  return support::run_program(MJARM_PROGRAM, arguments, options);
}

/// Runs `mjarm ik`.
inline support::ProgramResult ik(std::vector<std::string> arguments,
                                 const std::vector<std::string>& more = {},
                                 const support::RunOptions& options = {}) {
  arguments.insert(arguments.begin(), "ik");
  arguments.insert(arguments.end(), more.begin(), more.end());
  return mjarm(arguments, options);
}

/// Path of a file of the shipped models.
inline std::string model_file(const std::string& name) {
  return std::string(MJARM_MODELS) + "/" + name;
}

inline const std::string kUr5eScene = model_file("universal_robots_ur5e/scene.xml");

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

inline std::vector<double> numbers(const nlohmann::json& list) {
  return list.get<std::vector<double>>();
}

/// Pose written as `pos` and `quat`.
inline Pose pose_of(const nlohmann::json& object) {
  const auto p = numbers(object.at("pos")), q = numbers(object.at("quat"));
  EXPECT_EQ(p.size(), 3u);
  EXPECT_EQ(q.size(), 4u);
  EXPECT_NEAR(Quat(q[0], q[1], q[2], q[3]).norm(), 1, 1e-14);
  return {{p[0], p[1], p[2]}, to_matrix(Quat(q[0], q[1], q[2], q[3]))};
}

}  // namespace mjarm::app
