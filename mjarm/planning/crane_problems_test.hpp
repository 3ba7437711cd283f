#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace mjarm::testing {

/// A slide along x and a hinge about z that carry one ball of 20 mm, half a metre off; and a post
/// that stands still.
inline nlohmann::json two_joint_robot() {
  const nlohmann::json straight = {1, 0, 0, 0};
  return {{"name", "crane"},
          {"base", "world"},
          {"joint_names", {"rail", "arm"}},
          {"lower", {-2, -3}},
          {"upper", {2, 3}},
          {"joints",
           {{{"name", "rail"},
             {"type", "prismatic"},
             {"parent", "world"},
             {"child", "carriage"},
             {"xyz", {0, 0, 0.5}},
             {"quat", straight},
             {"axis", {1, 0, 0}},
             {"limits", {-2, 2}}},
            {{"name", "arm"},
             {"type", "revolute"},
             {"parent", "carriage"},
             {"child", "hand"},
             {"xyz", {0, 0, 0}},
             {"quat", straight},
             {"axis", {0, 0, 1}},
             {"limits", {-3, 3}}}}},
          {"spheres",
           {{{"link", "world"}, {"center", {0, 1.5, 0.5}}, {"radius", 0.1}},
            {{"link", "hand"}, {"center", {0, 0.5, 0}}, {"radius", 0.02}}}},
          {"self_collision_link_pairs",
           nlohmann::json::array({nlohmann::json::array({"world", "hand"})})}};
}

inline nlohmann::json crane_problem(const std::string& id, const std::string& scene,
                                    const nlohmann::json& obstacles) {
  return {{"id", id},
          {"scene", scene},
          {"index", 0},
          {"start", {-1, 0}},
          {"goals", {{5, 5}, {1, 0}}},
          {"obstacles", obstacles},
          {"valid", true},
          {"start_free", true},
          {"goals_free", {false, true}}};
}

inline nlohmann::json crane_box(const std::string& name, const nlohmann::json& pos,
                                const nlohmann::json& half) {
  return {{"name", name}, {"type", "box"}, {"pos", pos}, {"quat", {1, 0, 0, 0}}, {"half", half}};
}

/// Nothing in the way; a plate of 0.1 mm across the straight way; a pillar beside it, whose
/// replacement by a box has corners that its own round shape has not.
inline nlohmann::json crane_problems() {
  nlohmann::json pillar = {
      {"name", "pillar"},      {"type", "cylinder"},
      {"pos", {0, 0.67, 0.5}}, {"quat", {0.92387953, 0, 0, 0.38268343}},  // an eighth of a turn
      {"radius", 0.12},        {"length", 1},
      {"vamp_as", "box"}};
  return {{"format", "test"},
          {"robot", two_joint_robot()},
          {"problems",
           {crane_problem("crane/open/0", "open", nlohmann::json::array()),
            crane_problem(
                "crane/plate/0", "plate",
                nlohmann::json::array({crane_box("plate", {0.3, 0.5, 0.5}, {5e-5, 0.2, 0.2})})),
            crane_problem("crane/pillar/0", "pillar", nlohmann::json::array({pillar}))}}};
}

inline const nlohmann::json kCraneStraight = {{-1, 0}, {1, 0}};
/// The hand turns away, passes on the other side, and turns back.
inline const nlohmann::json kCraneRound = {{-1, 0}, {-1, 3}, {1, 3}, {1, 0}};

}  // namespace mjarm::testing
