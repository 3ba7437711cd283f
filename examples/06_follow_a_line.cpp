// Joint values along a line, or where it stops, why, and what mends it.
#include <cstdio>

#include "mjarm/core/rotation.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/path/path_fix.hpp"
#include "mjarm/path/path_measures.hpp"
#include "mjarm/path/solve_curve.hpp"

int main() {
  const auto robot = mjarm::load_robot("ur5e");
  if (!robot) return std::fprintf(stderr, "%s\n", robot.error().what.c_str()), 1;
  const mjarm::Arm& arm = robot->arm;
  const mjarm::IkSolver ik(arm);
  const auto home = mjarm::as_span(arm.home);
  const Eigen::Matrix3d down = mjarm::from_euler({3.14159265, 0, 0});

  const auto line = mjarm::Curve::line({{0.4, -0.4, 0.4}, down}, {{-0.4, -0.4, 0.4}, down});
  const auto path = mjarm::solve_curve(ik, *line, home);
  if (!path) return std::fprintf(stderr, "%s\n", describe(path.error(), arm).c_str()), 1;
  const mjarm::PathMeasures measures = mjarm::measure_path(arm, path->q);
  std::printf("%zu waypoints, joint steps up to %.3f rad, manipulability %.3f or more\n",
              path->q.size(), path->max_step(), measures.manipulability.value);

  // Through the first axis, where this arm cannot be.
  const auto bad = mjarm::Curve::line({{0.4, -0.05, 0.4}, down}, {{-0.4, -0.05, 0.4}, down});
  const auto stopped = mjarm::solve_curve(ik, *bad, home);
  if (stopped) return 1;
  std::printf("%s\n", describe(stopped.error(), arm).c_str());
  for (const mjarm::PathFix& fix : find_fixes(ik, *bad, home, {}, stopped.error())) {
    std::printf("It works if you %s.\n", describe(fix).c_str());
  }
}
