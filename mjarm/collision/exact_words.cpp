#include "mjarm/collision/exact.hpp"
#include "mjarm/core/messages/collision.hpp"

namespace mjarm {

std::string describe(const CollisionReport& report) {
  if (!report.contacts.empty()) {
    const ContactPoint& worst = report.contacts.front();
    return text(msg::collision_overlap, worst.pair.geom1, worst.pair.body1, worst.pair.geom2,
                worst.pair.body2, worst.depth);
  }
  if (!report.nearest) return text(msg::collision_free);
  const NearestPair& nearest = *report.nearest;
  return text(msg::collision_free_by, nearest.pair.geom1, nearest.pair.geom2, nearest.distance);
}

}  // namespace mjarm
