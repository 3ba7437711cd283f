// Does the arm touch itself or the scene, where, and how near is the next pair?
#include <cstdio>
#include <vector>

#include "mjarm/collision/exact.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/model.hpp"

int main() {
  const auto model = mjarm::find_model_file("ur5e").and_then(
      [](const auto& file) { return mjarm::Model::load(file); });
  if (!model) return std::fprintf(stderr, "%s\n", model.error().what.c_str()), 1;
  const auto arm = mjarm::find_arm(*model);
  if (!arm) return std::fprintf(stderr, "%s\n", arm.error().what.c_str()), 1;
  mjarm::ExactChecker checker(*model, *arm, {.margin = 1.0});

  const std::vector<double> below_the_floor = {0, 0, 2.65, -1.3, 1.55, 0};  // [rad]
  for (const auto& q : {mjarm::view(arm->home), std::span<const double>(below_the_floor)}) {
    const auto report = checker.check(q);
    if (!report) return std::fprintf(stderr, "%s\n", report.error().what.c_str()), 1;
    std::printf("%s: %s\n", report->free ? "free" : "touches", describe(*report).c_str());
  }
}
