#include "mjarm/path/clearance.hpp"

#include <memory>
#include <utility>

namespace mjarm {

ClearanceCheck clearance_check(const ExactChecker& checker) {
  auto own = std::make_shared<ExactChecker>(checker);
  const auto measure = [own](std::span<const double> q) {
    Clearance out;
    Result<CollisionReport> report = own->check(q);
    if (!report) {
      out.distance = -std::numeric_limits<double>::infinity();
    } else if (!report->free) {
      out = {-report->contacts.front().depth, std::move(report->contacts.front().pair)};
    } else if (report->nearest) {
      out = {report->nearest->distance, std::move(report->nearest->pair)};
    }
    return out;
  };
  return {measure, [own](std::span<const double> q) { return own->is_free(q); },
          [own](std::span<const double> q) { return own->least_distance(q); }};
}

}  // namespace mjarm
