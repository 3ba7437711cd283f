#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "mjarm/collision/obstacles.hpp"
#include "mjarm/collision/sphere_set.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "tests/support/test_data.hpp"

/// The planning problems of MotionBenchMaker in their neutral form (robot, sphere set, scenes).
namespace mjarm::testing {

struct PlanningProblem {
  std::string id;
  std::vector<double> start;
  std::vector<std::vector<double>> goals;
  Obstacles obstacles;  ///< cylinders as the reference replaces them
  bool valid = false, start_free = false;
  std::vector<bool> goals_free;
};

struct PlanningProblems {
  Arm arm;
  SphereSet set;
  std::vector<PlanningProblem> problems;
};

inline Eigen::Vector3d vector_of(const nlohmann::json& v) {
  return {v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>()};
}

inline Pose pose_of(const nlohmann::json& from, const char* place) {
  const auto& q = from.at("quat");
  const Eigen::Quaterniond quat(q.at(0).get<double>(), q.at(1).get<double>(), q.at(2).get<double>(),
                                q.at(3).get<double>());
  return {vector_of(from.at(place)), quat.normalized().toRotationMatrix()};
}

/// `as_given`: cylinders stay cylinders.
inline Obstacle obstacle_of(const nlohmann::json& from, bool as_given = false) {
  Obstacle out;
  out.name = from.at("name").get<std::string>();
  const std::string type = from.at("type").get<std::string>();
  if (type == "sphere") {
    out.X_WO.p = vector_of(from.at("pos"));
    out.shape = BallShape{from.at("radius").get<double>()};
    return out;
  }
  out.X_WO = pose_of(from, "pos");
  if (type == "box") {
    out.shape = BoxShape{vector_of(from.at("half"))};
    return out;
  }
  const double radius = from.at("radius").get<double>();
  const double half = 0.5 * from.at("length").get<double>();
  if (as_given) {
    out.shape = CylinderShape{radius, half};
  } else if (from.at("vamp_as") == "box") {
    out.shape = BoxShape{{radius, radius, half}};
  } else {
    out.shape = CapsuleShape{radius, half};
  }
  return out;
}

/// The moving joints of a problem file as an arm, and where each of its links is.
inline void read_robot(const nlohmann::json& robot, PlanningProblems& out) {
  struct Place {
    int joint = -1;
    Pose X;  // in the moved frame of that joint
  };
  std::map<std::string, Place> places{{robot.at("base").get<std::string>(), Place{}}};
  out.arm = make_arm(robot.at("name").get<std::string>(), {}, {});
  std::vector<double> lower, upper;
  for (const auto& joint : robot.at("joints")) {
    Place place = places[joint.at("parent").get<std::string>()];
    place.X = place.X * pose_of(joint, "xyz");
    if (joint.contains("axis") && joint.at("type") != "fixed") {
      ArmJoint moving;
      moving.name = joint.at("name").get<std::string>();
      moving.X_PJ = place.X;
      moving.axis = vector_of(joint.at("axis")).normalized();
      moving.type = joint.at("type") == "prismatic" ? JointType::slide : JointType::hinge;
      out.arm.joints.push_back(moving);
      lower.push_back(joint.at("limits").at(0).get<double>());
      upper.push_back(joint.at("limits").at(1).get<double>());
      place = {static_cast<int>(out.arm.joints.size()) - 1, Pose()};
    }
    places[joint.at("child").get<std::string>()] = place;
  }
  out.arm.limits.lower = joint_vec(lower);
  out.arm.limits.upper = joint_vec(upper);
  std::map<std::string, int> links;
  for (const auto& sphere : robot.at("spheres")) {
    const std::string name = sphere.at("link").get<std::string>();
    const Place& place = places.at(name);
    if (links.try_emplace(name, static_cast<int>(links.size())).second) {
      out.set.links.push_back({name, place.joint, {}});
    }
    out.set.links[static_cast<std::size_t>(links[name])].spheres.push_back(
        {place.X * vector_of(sphere.at("center")), sphere.at("radius").get<double>()});
  }
  for (const auto& pair : robot.at("self_collision_link_pairs")) {
    out.set.pairs.push_back(
        {links.at(pair.at(0).get<std::string>()), links.at(pair.at(1).get<std::string>())});
  }
}

inline PlanningProblems read_problems(const std::filesystem::path& file) {
  const nlohmann::json json = support::load_json(file);
  PlanningProblems out;
  read_robot(json.at("robot"), out);
  for (const auto& from : json.at("problems")) {
    PlanningProblem problem;
    problem.id = from.at("id").get<std::string>();
    problem.start = from.at("start").get<std::vector<double>>();
    problem.goals = from.at("goals").get<std::vector<std::vector<double>>>();
    problem.valid = from.at("valid").get<bool>();
    problem.start_free = from.at("start_free").get<bool>();
    problem.goals_free = from.at("goals_free").get<std::vector<bool>>();
    for (const auto& solid : from.at("obstacles")) {
      problem.obstacles.solids.push_back(obstacle_of(solid));
    }
    out.problems.push_back(std::move(problem));
  }
  return out;
}

}  // namespace mjarm::testing
