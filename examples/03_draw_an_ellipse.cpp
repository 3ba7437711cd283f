// From a curve to joint motion in time: IK along the curve, then timing within the joint limits.
#include <cstdio>

#include "mjarm/core/rotation.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/trajectory/tool_motion.hpp"

int main() {
  const auto robot = mjarm::load_robot("ur5e");
  if (!robot) return std::fprintf(stderr, "%s\n", robot.error().what.c_str()), 1;
  const mjarm::Arm& arm = robot->arm;
  const mjarm::IkSolver ik(arm);

  const auto curve = mjarm::Curve::ellipse(
      {.center = {0, -0.3, 0.5}, .a = 0.3, .b = 0.15, .R = mjarm::from_euler({3.14, 0, 0})});
  if (!curve) return std::fprintf(stderr, "%s\n", curve.error().what.c_str()), 1;
  const auto motion = mjarm::plan_tool_motion(ik, *curve, mjarm::as_span(arm.home),
                                              {.timing = {.tool_speed = 0.25}});
  if (!motion) return std::fprintf(stderr, "%s\n", describe(motion.error(), arm).c_str()), 1;

  const mjarm::LimitUse use = mjarm::check_limits(motion->trajectory, arm.limits);
  std::printf("%.3f m of curve in %.2f s, largest joint step %.4f rad, limits used %.0f %%\n",
              curve->length(), motion->trajectory.duration(), motion->path.max_step(),
              100 * use.worst());
}
