#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/planning/task_region.hpp"

namespace mjarm {

/// What a file says of one edge of a path.
struct GivenCertificate {
  double step = 0;                ///< [rad or m, L2] of the narrowest interval
  double clearance = 0;           ///< [m]
  double t = 0;                   ///< where on the edge
  std::optional<double> kept;     ///< [m] all along the edge
  std::vector<std::string> pair;  ///< link, and obstacle or link; empty: nothing near
};

/// What a user or a file adds to a model's rules about contacts.
struct RuleWords {
  std::vector<std::string> hold;   ///< bodies that hang on the tool
  std::vector<std::string> allow;  ///< `A,B`: bodies or geoms that may touch

  [[nodiscard]] bool any() const { return !hold.empty() || !allow.empty(); }
};

/// What a file says of how the tool leans.
struct GivenTilt {
  double limit = 0;                 ///< [rad] 0 to pi/2
  double largest = 0;               ///< [rad] 0 to limit
  std::vector<double> tool, world;  ///< (3,) directions of the tool and of the world
};

/// What a file says of the region that the tool keeps within.
struct GivenRegion {
  TaskRegion region;
  RegionRoom room = {};  ///< all along the path
};

/// One path of a file.
struct GivenPath {
  std::string id;
  std::vector<std::vector<double>> rows;  ///< corners, all of one size; none: no path is given
  std::optional<double> cost;             ///< [rad or m]
  std::optional<std::vector<GivenCertificate>> certificate;
  std::optional<GivenTilt> tilt;
  std::optional<GivenRegion> within;
  std::optional<double> clearance;  ///< [m] kept by all edges but, maybe, the first and the last
  RuleWords rules;
};

/// Reads a file of plans, as `mjarm plan` writes them,
/// `{"ID":{"ok":true,"path":[[q],...],...},...}`, or bare,
/// `{"ID":[[q],...],...}`. What is not ok has no path.
/// @param dof  how many values a row must have.
/// @return an error that names the file, the id and the row.
[[nodiscard]] Result<std::vector<GivenPath>> read_plan_file(const std::string& path,
                                                            std::size_t dof);

}  // namespace mjarm
