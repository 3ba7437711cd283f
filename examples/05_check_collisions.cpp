// Does the arm touch itself or the scene, where, and how near is the next pair?
#include <cstdio>
#include <vector>

#include "mjarm/collision/exact.hpp"
#include "mjarm/model/robot.hpp"

int main() {
  const auto robot = mjarm::load_robot("ur5e");
  if (!robot) return std::fprintf(stderr, "%s\n", robot.error().what.c_str()), 1;
  const auto& [model, arm] = *robot;
  auto checker = mjarm::ExactChecker::create(model, arm, {.margin = 1.0});
  if (!checker) return std::fprintf(stderr, "%s\n", checker.error().what.c_str()), 1;

  const std::vector<double> below_the_floor = {0, 0, 2.65, -1.3, 1.55, 0};  // [rad]
  for (const auto& q : {mjarm::as_span(arm.home), std::span<const double>(below_the_floor)}) {
    const auto report = checker->check(q);
    if (!report) return std::fprintf(stderr, "%s\n", report.error().what.c_str()), 1;
    std::printf("%s: %s\n", report->free ? "free" : "touches", describe(*report).c_str());
  }
}
