#include <memory>

#include "mjarm/path/tool_target.hpp"

namespace mjarm {

TargetContact exact_contact(const Model& model, const Arm& arm) {
  const auto checker = std::make_shared<ExactChecker>(model, arm, ExactOptions{.margin = 0});
  if (!checker->is_free(as_span(arm.home))) return {};
  return {[checker](std::span<const double> q) { return checker->is_free(q); },
          [checker](std::span<const double> q) -> std::optional<CollisionReport> {
            Result<CollisionReport> report = checker->check(q);
            return report ? std::optional(std::move(*report)) : std::nullopt;
          }};
}

}  // namespace mjarm
