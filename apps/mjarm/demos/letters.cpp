#include "mjarm/path/letters.hpp"

#include <algorithm>

#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/demos/program_demo.hpp"
#include "apps/mjarm/demos/tutorial.hpp"

namespace mjarm::app {
namespace {

constexpr double kHeight = 0.2;   // [m] of a letter, as the tutorial's
constexpr double kWidest = 0.7;   // [m] of a line of text
constexpr double kPlane = -0.5;   // [m] y of the plane written on, where the arm has room
constexpr double kBottom = 0.35;  // [m]

/// `text` upright in front of the arm, centred, smaller where it would get too wide; one polyline a
/// stroke.
Result<program::Program> written(const std::string& text) {
  const auto flat = letter_strokes(text, 1);
  if (!flat) return fail(flat.error());
  double width = 0;
  for (const Stroke& points : *flat) {
    for (const Eigen::Vector2d& p : points) width = std::max(width, p.x());
  }
  const double scale = std::min(kHeight, kWidest / std::max(width, 1e-9));
  program::Program program;
  program.name = "letters";
  for (const Stroke& points : *flat) {
    program::DrawPolyline stroke;
    for (const Eigen::Vector2d& p : points) {
      const Eigen::Vector3d p_W(scale * (p.x() - width / 2), kPlane, kBottom + scale * p.y());
      stroke.points.push_back({{p_W, tool_down()}});
    }
    program.instructions.push_back({std::move(stroke)});
  }
  return program;
}

}  // namespace

Result<Report> run_letters(const DemoOptions& options) {
  Result<program::Program> program =
      options.text.empty() ? demo_program("letters") : written(options.text);
  if (!program) return fail(std::move(program.error()));
  const Result<program::LoadedProgram> loaded = plan_demo(std::move(*program), options);
  if (!loaded) return fail(loaded.error());
  return run_demo_plan(*loaded, options);
}

}  // namespace mjarm::app
