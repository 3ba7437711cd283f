#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mjarm/collision/contact_rules.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// How a configuration is checked. Every default is usable as is.
struct ExactOptions {
  double margin = 0.1;      ///< [m] up to where check() looks for the nearest pair, >= 0; 0 = never
  double allow_depth = 0;   ///< [m] overlap that still counts as free, >= 0
  ContactRules rules = {};  ///< what hangs on the tool, what may touch
  /// (nq,) [rad or m] where joints off the arm stand; empty: home_configuration().
  std::vector<double> qpos = {};
  /// [m] by which attached bodies may overlap what the arm does not move, >= 0: they lie on things
  /// when they are picked up and put down. So much of an overlap counts as a distance of 0.
  double rest_depth = 0;
  /// Look for the nearest pair not among neighbours, which are near to each other whatever the arm
  /// does: links with at most three joints between them, unless they are nearer than 20 mm and not
  /// proved never to meet within the limits of these joints.
  bool skip_neighbours = false;
};

/// Two geoms and the bodies they belong to, by name. A geom without a name is called BODY[k], the
/// k-th (from 0) of its body.
struct GeomPair {
  std::string geom1, geom2;
  std::string body1, body2;
};

/// Two geoms that overlap, at the place where they do so most.
struct ContactPoint {
  GeomPair pair;
  double depth = 0;          ///< [m] overlap along the normal, > 0
  Eigen::Vector3d point_W;   ///< [m] midway between the two surfaces
  Eigen::Vector3d normal_W;  ///< unit, from geom 1 to geom 2
};

/// The two geoms that are nearest to each other, of those whose distance the arm can change (a
/// first link that turns over the floor always is as near to it).
struct NearestPair {
  GeomPair pair;
  double distance = 0;   ///< [m] between the surfaces; negative where they overlap
  Eigen::Vector3d p1_W;  ///< [m] nearest point of geom 1
  Eigen::Vector3d p2_W;  ///< [m] nearest point of geom 2
};

/// What a check found.
struct CollisionReport {
  bool free = true;                    ///< no overlap deeper than ExactOptions::allow_depth
  std::vector<ContactPoint> contacts;  ///< one a pair of geoms that overlap, deepest first
  std::optional<NearestPair> nearest;  ///< none where nothing is nearer than ExactOptions::margin
};

/// One line for people: the deepest contact, or that the configuration is free and by how much.
[[nodiscard]] std::string describe(const CollisionReport& report);

/// The exact collision checker: MuJoCo's own kinematics and collision detection on one
/// configuration of an arm, with MuJoCo's rules about which geoms collide (contype and conaffinity,
/// parent and child, excludes, explicit pairs). Only pairs count that the arm's joints move
/// against each other (gripper included); a box that lies on the floor does not, nor do two
/// fingers. Joints off the arm stand as in ExactOptions::qpos. Contacts
/// are checked even where the file switches them off. Owns its scratch memory: copy it to use it
/// from another thread.
class ExactChecker {
 public:
  /// For options that a user chose.
  /// @return check_contact_rules()'s error; bad_input for an arm that is not of `model`, or a
  /// margin or depth that is negative or not finite.
  [[nodiscard]] static Result<ExactChecker> create(const Model& model, const Arm& arm,
                                                   const ExactOptions& options);
  /// For an arm of `model` and options that are known to be sound: with others every check answers
  /// with an error.
  ExactChecker(const Model& model, const Arm& arm, const ExactOptions& options = {});
  ~ExactChecker();
  ExactChecker(const ExactChecker& other);
  ExactChecker& operator=(const ExactChecker& other);
  ExactChecker(ExactChecker&&) noexcept;
  ExactChecker& operator=(ExactChecker&&) noexcept;

  /// Looks at `q`, shape (dof,) [rad or m]; limits are not looked at.
  /// @return bad_input for a wrong size, a number that is not finite, or rules that are not sound.
  [[nodiscard]] Result<CollisionReport> check(std::span<const double> q);

  /// The short way: true where check(q) would say free; false also where it would fail.
  [[nodiscard]] bool is_free(std::span<const double> q);

  /// [m] The distance of the nearest pair that check(q) would tell is not less, as far as that
  /// follows from what was looked at last: takes no look. Infinite where check(q) would tell none,
  /// minus infinity where nothing is known.
  [[nodiscard]] double least_distance(std::span<const double> q) const;

  /// is_free() of a checker of its own, as a predicate for IkOptions::valid. Copies of the
  /// predicate share that checker, so each thread needs one of its own.
  [[nodiscard]] std::function<bool(std::span<const double>)> predicate() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm
