#include "mjarm/collision/first_contact.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "mjarm/core/messages/collision.hpp"

namespace mjarm {

Result<std::optional<EdgeContact>> first_contact(ExactChecker& checker, std::span<const double> q0,
                                                 std::span<const double> q1, double step,
                                                 const StopCheck& stop) {
  constexpr double kMaxSteps = 1e8;
  // The ends are looked at first of all: a wrong size or number shows here.
  for (const std::span<const double> end : {q0, q1}) {
    if (const auto report = checker.check(end); !report) return fail(report.error());
  }
  double squares = 0;
  for (std::size_t i = 0; i < q0.size(); ++i) squares += (q1[i] - q0[i]) * (q1[i] - q0[i]);
  const double pieces = std::max(std::ceil(std::sqrt(squares) / step), 1.0);
  if (!(step > 0) || !(pieces <= kMaxSteps)) {
    return fail(Errc::bad_input, text(msg::collision_walk_step, step));
  }
  std::vector<double> q(q0.size());
  for (double k = 0; k <= pieces; ++k) {
    if (is_stopped(stop)) return fail(stopped());
    const double t = k / pieces;
    for (std::size_t i = 0; i < q.size(); ++i) q[i] = q0[i] + t * (q1[i] - q0[i]);
    if (checker.is_free(q)) continue;  // the short way, which most samples go
    Result<CollisionReport> report = checker.check(q);
    if (!report) return fail(std::move(report.error()));
    if (report->free) continue;
    return EdgeContact{t, std::move(report->contacts.front())};
  }
  return std::nullopt;
}

}  // namespace mjarm
