#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace mjarm::testing {

inline nlohmann::json turning_link(const std::string& name, const std::string& parent, double x) {
  return {{"name", name + "_joint"}, {"type", "revolute"},   {"parent", parent},
          {"child", name},           {"xyz", {x, 0, 0}},     {"quat", {1, 0, 0, 0}},
          {"axis", {0, 0, 1}},       {"limits", {-2.9, 2.9}}};
}

/// A file of problems: a flat arm of two links and a post between start and goal of the problem
/// "round".
inline nlohmann::json two_problems() {
  using nlohmann::json;
  json spheres = json::array();
  for (const char* name : {"upper", "lower"}) {
    for (int k = 1; k <= 5; ++k) {
      spheres.push_back({{"link", name}, {"center", {0.1 * k, 0, 0}}, {"radius", 0.06}});
    }
  }
  const json post = {{"name", "post"},       {"type", "cylinder"}, {"pos", {0.7, 0, 0}},
                     {"quat", {1, 0, 0, 0}}, {"radius", 0.05},     {"length", 0.6},
                     {"vamp_as", "capsule"}};
  const auto problem = [&](const char* id, std::vector<double> start, std::vector<double> goal) {
    return json{{"id", id}, {"start", start}, {"goals", {goal}}, {"obstacles", {post}}};
  };
  json file;
  file["robot"] = {
      {"name", "flat"},
      {"base", "base"},
      {"joints", {turning_link("upper", "base", 0), turning_link("lower", "upper", 0.5)}},
      {"spheres", spheres},
      {"self_collision_link_pairs", json::array()}};
  file["problems"] = {problem("round", {0.8, 0}, {-0.8, 0}),
                      problem("straight", {0.8, 0}, {1.2, 0.2})};
  return file;
}

}  // namespace mjarm::testing
