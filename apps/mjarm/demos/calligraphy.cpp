#include <algorithm>
#include <filesystem>

#include "apps/mjarm/demos/demo_stage.hpp"
#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/demos/program_demo.hpp"
#include "apps/mjarm/messages/demo.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/path/hanzi.hpp"
#include "mjarm/path/letters.hpp"

namespace mjarm::app {
namespace {

const Eigen::Vector3d kPaper(0, -0.47, 0.08);  // [m] middle of the sheet in calligraphy.xml
constexpr double kInkHeight = 0.12, kSheetWidth = 0.36;  // [m] of a letter, and of all

/// What is written where nothing is asked for: a character once they are installed, else the
/// letters of the shipped program.
std::string default_text(const std::string& letters) {
  const Result<std::filesystem::path> file = hanzi_file();
  std::error_code ignored;
  if (file && std::filesystem::exists(*file, ignored)) return "永";
  log_info(text(msg::demo_calligraphy_letters, letters));
  return letters;
}

/// The shipped program with the text in the middle of the sheet, as if it lay level, smaller where
/// it would get too wide and no height is asked for.
Result<program::Program> sheet(const DemoValues& values) {
  Result<program::Program> program = demo_program("calligraphy");
  if (!program) return program;
  // What the user wants stands on no line of the program.
  for (program::Instruction& instruction : program->instructions) instruction.place = {};
  auto& what = std::get<program::DrawText>(program->instructions.front().what);
  what.text = values.text.empty() ? default_text(what.text) : values.text;
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
