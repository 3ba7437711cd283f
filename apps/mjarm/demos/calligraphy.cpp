#include <algorithm>
#include <filesystem>

#include "apps/mjarm/demos/demo_stage.hpp"
#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/demos/program_demo.hpp"
#include "apps/mjarm/demos/tutorial.hpp"
#include "apps/mjarm/messages/demo.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/path/hanzi.hpp"
#include "mjarm/path/letters.hpp"

namespace mjarm::app {
namespace {

const Eigen::Vector3d kPaper(0, -0.47, 0.08);  // [m] middle of the sheet in calligraphy.xml
constexpr double kInkHeight = 0.12, kSheetWidth = 0.36;  // [m] of a letter, and of all
constexpr double kPenForce = 1;                          // [N]
constexpr double kPenSpeed = 0.02;                       // [m/s]

/// What is written where nothing is asked for: characters, once they are installed.
std::string default_text() {
  const Result<std::filesystem::path> file = hanzi_file();
  std::error_code ignored;
  if (file && std::filesystem::exists(*file, ignored)) return "永";
  constexpr const char* kLetters = "ARM";
  log_info(text(msg::demo_calligraphy_letters, kLetters));
  return kLetters;
}

/// The text in the middle of the sheet, as if it lay level, smaller where it would get too wide and
/// no height is asked for.
Result<program::Program> sheet(const DemoValues& values) {
  program::DrawText what{.text = values.text.empty() ? default_text() : values.text,
                         .press = kPenForce,
                         .R_FT = tool_down(),
                         .speed = kPenSpeed};
  const auto flat = letter_strokes(what.text, 1);
  if (!flat) return fail(flat.error());
  double left = 1e9, right = -1e9;
  for (const Stroke& stroke : *flat) {
    for (const Eigen::Vector2d& p : stroke.points) {
      left = std::min(left, p.x());
      right = std::max(right, p.x());
    }
  }
  what.height =
      values.height.value_or(std::min(kInkHeight, kSheetWidth / std::max(right - left, 1e-9)));
  what.plane.X_FT.p = kPaper - what.height * Eigen::Vector3d((left + right) / 2, 0.5, 0);
  program::Program program;
  program.name = "calligraphy";
  program.scene = "universal_robots_ur5e/calligraphy.xml";
  program.tool = "pen_tcp";
  program.control = ControlMode::tool_impedance;
  program.settings.branch = parse_branch("elbow=up").value();  // above the sheet
  program.instructions.push_back({std::move(what)});
  program.instructions.push_back({program::MoveJ{program::JointValues{}}});
  return program;
}

}  // namespace

Result<Report> run_calligraphy(const DemoOptions& options) {
  Result<program::Program> program = sheet(options.values);
  if (!program) return fail(std::move(program.error()));
  const std::string file = "demo " + program->name;
  Result<Robot> robot = program::load_program_robot(*program, file);
  if (!robot) return fail(std::move(robot.error()));
  const Result<program::LoadedProgram> loaded =
      program::plan_loaded(file, std::move(*program), std::move(*robot), interrupted);
  return loaded ? run_demo_plan(*loaded, options) : fail(loaded.error());
}

}  // namespace mjarm::app
