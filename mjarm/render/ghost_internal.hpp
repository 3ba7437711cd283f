#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <span>

#include "mjarm/render/overlay.hpp"

namespace mjarm::render {

/// Draws a model at other joint values beside what is drawn of it already.
class Ghosts {
 public:
  /// `m` is kept; nothing is allocated before the first ghost is drawn.
  explicit Ghosts(const mjModel& m) : m_(&m) {}

  /// Adds the geoms of each ghost to `scene`; all that it does not name stands as in `d`. A geom
  /// that is where it is in `d` is not drawn again, and a ghost with a number that is not finite or
  /// for which there is no room is left out.
  void draw(std::span<const OverlayGhost> ghosts, const mjvOption& option, const mjData& d,
            mjvScene& scene);

 private:
  void draw_one(const OverlayGhost& ghost, const mjvOption& option, const mjData& d,
                mjvScene& scene);

  struct Delete {
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  const mjModel* m_;
  std::unique_ptr<mjData, Delete> d_;
};

}  // namespace mjarm::render
