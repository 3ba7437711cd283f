#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "mjarm/collision/contact_rules.hpp"
#include "mjarm/collision/edge_verdict.hpp"
#include "mjarm/collision/obstacles.hpp"
#include "mjarm/collision/sphere_set.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// How an edge is verified. Every default is usable as is.
struct VerifyOptions {
  double allow_depth = 0;  ///< [m] overlap that still counts as free, >= 0
  /// [m] >= 0: distance that moving links keep from obstacles, and paired links from each other.
  double keep = 0;
  double limit_slack = 1e-4;    ///< [rad or m] by which a joint may be past its limit, >= 0
  double least_step = 1e-6;     ///< [rad or m, L2] shortest step along the edge, > 0
  long max_looks = 10'000'000;  ///< a link looked at against one obstacle or link, > 0
  StopCheck stop = {};
};

/// What verify_edge() found. `undecided`: at `t` something touches (to 1e-12 m) or the looks are
/// used up.
struct VerifyResult {
  EdgeVerdict verdict = EdgeVerdict::free;
  double t = 0;  ///< where on the edge, 0 to 1; of a free edge: where it is nearest to anything
  /// [m] clearance of the pair at `t`, allow_depth not counted; negative: overlap. Of a free edge
  /// the least that was met; infinite where there is nothing to hit.
  double distance = 0;
  int link = -1;        ///< of the pair, by index into the sphere set
  int obstacle = -1;    ///< the other of the pair; -1: a link
  int other_link = -1;  ///< that link
  int joint = -1;       ///< outside: the first joint that is
};

/// Proves or refutes that the straight edge q(t) = q0 + t (q1 - q0), t in [0, 1], is free: the
/// second opinion on check_edge(), with which it shares nothing but the forward kinematics in
/// double precision. Each link marches by itself against each obstacle and each link it is paired
/// with (conservative advancement; B. Mirtich, Impulse-based dynamic simulation, 1996, ch. 2). The
/// distance to a convex solid is a convex function of the place, so after a step h it is at least
/// its value now, plus h times its slope, less h^2 / 2 times a bound of the second derivative of
/// the place. That bound comes from the lengths of the links, the slope from two distances. Meshes
/// and height fields are not convex: there the slope is taken to be the speed, so that a way close
/// along them may stay undecided.
/// @param q0, q1  shape (dof,) [rad or m].
/// @return check_sphere_set()'s or check_obstacles()'s error, one about the options or the shape of
/// q0 and q1, or stopped().
[[nodiscard]] Result<VerifyResult> verify_edge(const Arm& arm, const SphereSet& set,
                                               const Obstacles& obstacles,
                                               std::span<const double> q0,
                                               std::span<const double> q1,
                                               const VerifyOptions& options = {});

/// The same of the geoms of a model, whose distances MuJoCo measures: the second opinion on a
/// checker that looks closer. Pairs that are proved never to meet are left out, as by
/// cover_model(). Speeds take the place of slopes. Ground (height fields), whose distance MuJoCo
/// does not measure, is left out. Owns its scratch memory: copy it to use it from another thread.
class ModelMarch {
 public:
  /// Joints off the arm stand as in home_configuration().
  /// @return cover_model()'s errors.
  [[nodiscard]] static Result<ModelMarch> create(const Model& model, const Arm& arm,
                                                 const ContactRules& rules = {},
                                                 const StopCheck& stop = {});
  ~ModelMarch();
  ModelMarch(const ModelMarch& other);
  ModelMarch& operator=(const ModelMarch& other);
  ModelMarch(ModelMarch&&) noexcept;
  ModelMarch& operator=(ModelMarch&&) noexcept;

  /// The result has indices for link_name() and obstacle_name().
  [[nodiscard]] Result<VerifyResult> verify_edge(std::span<const double> q0,
                                                 std::span<const double> q1,
                                                 const VerifyOptions& options = {});
  /// [m] between a link and an obstacle, or two links, of these names at `q`, shape (dof,); none
  /// where no such pair can meet.
  [[nodiscard]] std::optional<double> distance(const std::string& link, const std::string& other,
                                               std::span<const double> q);
  [[nodiscard]] const std::string& link_name(int link) const;
  [[nodiscard]] const std::string& obstacle_name(int obstacle) const;

 private:
  struct Impl;
  explicit ModelMarch(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm
