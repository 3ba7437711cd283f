#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "mjarm/path/path_fix.hpp"

namespace mjarm::detail {

/// Looks for the least change that mends a path.
class FixSearch {
 public:
  /// Solves the whole changed path. @return its first answer, none where it fails.
  using Solve = std::function<std::optional<JointVec>(const PathChange&, const PathOptions&)>;

  /// @param poses  the path, or samples of it; kept by reference, as the others.
  /// @param at     index of the one where it stops.
  FixSearch(const IkSolver& ik, std::span<const Pose> poses, std::size_t at,
            std::span<const double> q_start, const PathOptions& options, Solve solve);

  [[nodiscard]] std::optional<PathFix> find(FixKind kind, const PathFailure& failure);
  /// @param reach  [m] longest shift tried, >= 0.
  [[nodiscard]] std::optional<PathFix> shift(double reach);

 private:
  [[nodiscard]] bool mends(const PathChange& change);
  [[nodiscard]] std::optional<PathFix> tilt();
  [[nodiscard]] std::optional<PathFix> start() const;
  [[nodiscard]] std::optional<PathFix> longer_step(const PathFailure& failure) const;
  [[nodiscard]] std::optional<PathFix> slower(const PathFailure& failure) const;

  const IkSolver& ik_;
  std::span<const Pose> poses_;
  std::size_t at_;
  std::span<const double> q_start_;
  PathOptions options_;
  Solve solve_;
  std::vector<Pose> changed_;
  int max_probed_, max_solved_;  // of one kind of change; fewer where each takes long
  int probed_ = 0;               // changes that no proof refuted
  int solved_ = 0;               // changes solved as a whole
};

}  // namespace mjarm::detail
