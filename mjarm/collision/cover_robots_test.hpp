#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mjarm/collision/cover.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/model/find_arm.hpp"
#include "tests/support/temp_folder.hpp"

/// Robots to be covered: shipped ones and random ones.
namespace mjarm::testing {

struct CoveredRobot {
  Model model;
  Arm arm;
};

inline CoveredRobot covered_file(const std::filesystem::path& file, const std::string& tip = "") {
  Model model = Model::load(file).value();
  Arm arm = find_arm(model, {.tip = tip}).value();
  return {std::move(model), std::move(arm)};
}

inline CoveredRobot covered_robot(const char* name) {
  return covered_file(find_model_file(name).value());
}

inline std::string numbers(Rng& rng, int count, double low, double high) {
  std::string out;
  for (int i = 0; i < count; ++i) out += std::to_string(rng.uniform(low, high)) + " ";
  return out;
}

/// A geom of any kind a moving body may have, with random masks.
inline std::string random_geom(Rng& rng, double reach, double size) {
  static constexpr const char* kTypes[] = {"sphere",    "capsule", "box",
                                           "ellipsoid", "mesh",    "cylinder"};
  const std::string type = kTypes[rng.below(6)];
  std::string out = "<geom type=\"" + type + "\" pos=\"" + numbers(rng, 3, -reach, reach) +
                    "\" euler=\"" + numbers(rng, 3, -3, 3) + "\" ";
  out += type == "mesh" ? "mesh=\"rock" + std::to_string(rng.below(3)) + "\" "
                        : "size=\"" + numbers(rng, 3, 0.2 * size, size) + "\" ";
  if (rng.uniform() < 0.3) {
    out += "contype=\"" + std::to_string(rng.below(4)) + "\" conaffinity=\"" +
           std::to_string(rng.below(4)) + "\" ";
  }
  return out + "/>";
}

inline std::string random_meshes(Rng& rng) {
  std::string out = "<asset>";
  for (int k = 0; k < 3; ++k) {
    out += "<mesh name=\"rock" + std::to_string(k) + "\" vertex=\"" +
           numbers(rng, 3 * (5 + static_cast<int>(rng.below(20))), -0.08, 0.08) + "\"/>";
  }
  return out + "</asset>";
}

/// A chain of 2 to 5 joints with geoms, welded parts and a finger, things round it, excludes and
/// explicit pairs.
inline std::string random_tree(Rng& rng) {
  const int joints = 2 + static_cast<int>(rng.below(4));
  std::string body, end;
  for (int i = 0; i < joints; ++i) {
    const std::string id = std::to_string(i);
    const bool slide = rng.uniform() < 0.2;
    body += "<body name=\"b" + id + "\" pos=\"" + numbers(rng, 3, -0.2, 0.2) + "\" euler=\"" +
            numbers(rng, 3, -3, 3) + "\"><joint name=\"j" + id + "\" type=\"" +
            (slide ? "slide" : "hinge") + "\" axis=\"" + numbers(rng, 3, 0.1, 1) + "\" pos=\"" +
            numbers(rng, 3, -0.02, 0.02) + "\" range=\"" + (slide ? "-0.3 0.4" : "-2.5 2.8") +
            "\"/>" + "<geom name=\"g" + id + "\" type=\"capsule\" size=\"0.03 0.05\"/>" +
            random_geom(rng, 0.08, 0.08);
    if (rng.uniform() < 0.5) {
      body += "<body pos=\"" + numbers(rng, 3, -0.1, 0.1) + "\">" + random_geom(rng, 0.05, 0.06) +
              "</body>";
    }
    end += "</body>";
  }
  body +=
      "<site name=\"tip\"/><body name=\"finger\"><joint name=\"finger\" type=\"slide\" "
      "axis=\"1 0 0\" range=\"0 0.05\"/>" +
      random_geom(rng, 0.05, 0.04) + "</body>";
  std::string things;
  for (int k = 0; k < 4; ++k) things += random_geom(rng, 0.5, 0.15);
  things += "<geom name=\"floor\" type=\"plane\" size=\"1 1 1\" pos=\"0 0 -0.5\"/>";
  return "<mujoco><compiler angle=\"radian\"/>" + random_meshes(rng) + "<worldbody>" + things +
         body + end + "</worldbody><contact><exclude body1=\"b0\" body2=\"b" +
         std::to_string(joints - 1) + "\"/><pair geom1=\"g0\" geom2=\"g1\"/></contact></mujoco>";
}

}  // namespace mjarm::testing
