#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mjarm/path/path_layers_internal.hpp"

namespace mjarm::detail {

/// The best track along some poses.
struct Track {
  std::vector<JointVec> q =
      {};                   ///< answers to the first poses; all of them where the track completes
  Layer last = {};          ///< all that tracks lead to at the last of these, best first
  bool is_stopped = false;  ///< by PathOptions::stop; `q` is empty then
  [[nodiscard]] std::size_t size() const { return q.size(); }
};

/// Carries all answers along `poses` until the end or until none goes on.
[[nodiscard]] Track find_track(const PathLayers& layers, std::span<const Pose> poses,
                               const JointVec& q_start);

}  // namespace mjarm::detail
