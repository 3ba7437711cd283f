#include "mjarm/path/letters.hpp"

#include <algorithm>
#include <cmath>

#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/demos/program_demo.hpp"
#include "apps/mjarm/demos/tutorial.hpp"

namespace mjarm::app {
namespace {

constexpr double kHeight = 0.2;  // [m] of a letter, as the tutorial's
constexpr double kWidest = 0.7;  // [m] of a line of text
const Eigen::Vector3d kFoot(0, -0.5,
                            0.35);        // [m] below the middle of the text, where there is room
const Eigen::Vector3d kNormal(0, -1, 0);  // towards the reader: the text stands upright

/// Directions in the plane: to the right and up, for who looks against `normal`. Up is as near to
/// the world's z axis as the plane allows, to its y axis in a level plane.
struct WritingPlane {
  Eigen::Vector3d right, up;
};
WritingPlane plane_of(const Eigen::Vector3d& normal) {
  const Eigen::Vector3d w = normal.normalized();
  const Eigen::Vector3d upright =
      std::abs(w.z()) > 0.9 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d right = upright.cross(w).normalized();
  return {right, w.cross(right)};
}

/// The text centred, unless the user gives its place upright in front of the arm, and smaller where
/// it would get too wide and no height is asked for; one curve a stroke.
Result<program::Program> written(const DemoValues& values) {
  const auto flat = letter_strokes(values.text.empty() ? "LZ" : values.text, 1);
  if (!flat) return fail(flat.error());
  double width = 0;
  for (const Stroke& stroke : *flat) {
    for (const Eigen::Vector2d& p : stroke.points) width = std::max(width, p.x());
  }
  const double scale = values.height.value_or(std::min(kHeight, kWidest / std::max(width, 1e-9)));
  const auto [right, up] = plane_of(values.normal.value_or(kNormal));
  const Eigen::Vector3d foot = values.center ? *values.center - scale / 2 * up : kFoot;
  program::Program program;
  program.name = "letters";
  for (const Stroke& stroke : *flat) {
    std::vector<program::ProgramPose> points;
    for (const Eigen::Vector2d& p : stroke.points) {
      const Eigen::Vector3d p_W = foot + scale * ((p.x() - width / 2) * right + p.y() * up);
      points.push_back({{p_W, values.R.value_or(tool_down())}});
    }
    program.instructions.push_back(
        stroke.smooth ? program::Instruction{program::DrawSpline{std::move(points), kStrokeCorner}}
                      : program::Instruction{program::DrawPolyline{std::move(points)}});
  }
  return program;
}

}  // namespace

Result<Report> run_letters(const DemoOptions& options) {
  const DemoValues& values = options.values;
  const bool tutorials =
      values.text.empty() && !values.height && !values.center && !values.normal && !values.R;
  Result<program::Program> program = tutorials ? demo_program("letters") : written(values);
  if (!program) return fail(std::move(program.error()));
  const Result<program::LoadedProgram> loaded = plan_demo(std::move(*program), options);
  if (!loaded) return fail(loaded.error());
  return run_demo_plan(*loaded, options);
}

}  // namespace mjarm::app
