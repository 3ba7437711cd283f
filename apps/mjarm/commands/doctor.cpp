#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/print.hpp"
#include "apps/mjarm/cli/version.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "apps/mjarm/messages/models.hpp"
#include "apps/mjarm/messages/render_command.hpp"
#include "mjarm/core/cpu.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/install.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/os_child_input.hpp"
#include "mjarm/core/os_system.hpp"
#include "mjarm/core/text_width.hpp"
#include "mjarm/core/user_cache.hpp"
#include "mjarm/install/installed.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/model/mujoco_library.hpp"
#include "mjarm/perception/tag_detector.hpp"
#include "mjarm/planning/ompl_planners.hpp"
#include "mjarm/render/fonts.hpp"
#include "mjarm/render/gl_context.hpp"
#include "mjarm/session/teleop_devices.hpp"

namespace mjarm::app {
namespace {

struct Findings {
  JsonDoc facts;                      ///< for `--json`
  std::string lines;                  ///< for people
  std::vector<std::string> problems;  ///< what is needed and missing, one line each
};

void add(Findings& findings, const char* key, const std::string& label, JsonDoc value,
         const std::string& shown) {
  findings.facts.set(key, std::move(value));
  findings.lines += padded(label, 14) + shown + "\n";
}

void look_at_mujoco(Findings& findings) {
  const MujocoLibrary library = mujoco_library();
  add(findings, "mujoco", "MuJoCo", library.version,
      library.version + "  " + library.file.string());
  findings.facts.set("mujoco_library", library.file.string());
  if (!library.fits()) {
    findings.problems.push_back(text(msg::app_doctor_other_mujoco, library.built_against,
                                     library.version, library.file.string()));
  }
}

void look_at_machine(Findings& findings) {
  const OperatingSystem system = operating_system();
  const Msg said = system.is_wsl ? msg::app_doctor_wsl : msg::app_doctor_no_mac;
  add(findings, "system", text(msg::app_doctor_system), system.name, text(said, system.name));
  const std::string simd(name(simd_level()));
  add(findings, "compiler", text(msg::app_doctor_compiler), compiler(), compiler());
  add(findings, "simd", text(msg::app_doctor_simd), simd, simd);
  add(findings, "cores", text(msg::app_doctor_cores), core_count(), std::to_string(core_count()));
  const bool display = has_display();
  add(findings, "display", text(msg::app_doctor_display), display,
      text(display ? msg::app_doctor_display_yes : msg::app_doctor_display_no));
}

/// Pictures are part of every demo: one way to draw must work, two are better.
void look_at_graphics(Findings& findings) {
  std::vector<JsonDoc> ways;
  bool any = false;
  for (const render::GlBackend& way : render::probe_gl_backends()) {
    ways.push_back({{"name", way.name},
                    {"works", way.works},
                    {"renderer", way.renderer},
                    {"version", way.version},
                    {"reason", way.reason}});
    findings.lines += padded(way.name, 14) + (way.works ? way.renderer : way.reason) + "\n";
    any |= way.works;
  }
  findings.facts.set("gl", std::move(ways));
  if (!any) findings.problems.push_back(text(msg::app_doctor_no_gl));
}

/// Without one everything works, but plots and windows speak English.
void look_at_fonts(Findings& findings) {
  const std::string& font = render::chinese_font();
  add(findings, "chinese_font", text(msg::app_doctor_font), font,
      font.empty() ? text(msg::app_doctor_no_font) : font);
}

/// Only videos need it.
void look_at_ffmpeg(Findings& findings) {
  const std::string file = find_program("ffmpeg").string();
  add(findings, "ffmpeg", text(msg::render_command_doctor), file,
      file.empty() ? text(msg::render_command_doctor_none) : file);
}

/// Only users of its planners need it.
void look_at_ompl(Findings& findings) {
  const std::string version(ompl_version());
  add(findings, "ompl", "OMPL", version, version.empty() ? text(msg::app_doctor_no_ompl) : version);
}

/// Only who looks for tags in pictures needs it.
void look_at_apriltag(Findings& findings) {
  const bool built_in = perception::has_tags();
  const char* name = "AprilTag tag36h11";
  add(findings, "apriltag", "AprilTag", built_in,
      built_in ? name : text(msg::app_doctor_no_apriltag));
}

/// Only who leads arms by one needs it.
void look_at_space_mouse(Findings& findings) {
  const Result<session::SpaceMouse> mouse = session::SpaceMouse::open();
  add(findings, "space_mouse", "SpaceMouse", mouse.has_value(),
      mouse ? "libspnav" : mouse.error().what);
}

/// What is kept from run to run; safe to delete.
void look_at_cache(Findings& findings) {
  constexpr double kMega = 1e6;
  const std::optional<UserCache> cache = UserCache::of_user();
  const std::string folder = cache ? cache->folder().string() : std::string();
  add(findings, "cache", text(msg::app_doctor_cache), folder,
      cache ? text(msg::app_doctor_cache_size, folder, static_cast<double>(cache->size()) / kMega)
            : text(msg::app_doctor_no_cache));
}

void look_at_models(Findings& findings) {
  std::vector<JsonDoc> found;
  std::string names;
  for (const ShippedModel& shipped : shipped_models()) {
    const Result<Model> model = Model::load(shipped.file);
    if (!model) {
      findings.problems.push_back(
          text(msg::app_doctor_bad_model, shipped.name, model.error().what));
      continue;
    }
    found.push_back({{"name", shipped.name}, {"file", shipped.file.string()}});
    names += (names.empty() ? "" : text(msg::core_comma)) + shipped.name;
  }
  if (found.empty()) findings.problems.push_back(text(msg::app_doctor_no_models));
  add(findings, "models", text(msg::app_doctor_models), std::move(found),
      names.empty() ? text(msg::app_info_none) : names);
}

/// Meshes are a choice: without them robots are drawn with simple shapes.
void look_at_meshes(Findings& findings) {
  std::vector<JsonDoc> found;
  std::string shown, known;
  for (const install::MeshSet& set : install::mesh_sets()) {
    known += (known.empty() ? "" : text(msg::core_comma)) + set.robot;
    const Result<install::Installed> meshes = install::look_up(set);
    if (!meshes || meshes->state.kind == install::InstallState::Kind::absent) continue;
    const install::InstallState& state = meshes->state;
    const bool whole = state.kind == install::InstallState::Kind::whole;
    found.push_back({{"robot", set.robot}, {"whole", whole}, {"folder", meshes->folder.string()}});
    shown += (shown.empty() ? "" : text(msg::core_comma)) +
             (whole ? set.robot : text(msg::install_mend, state.problem, set.robot));
  }
  add(findings, "meshes", text(msg::models_doctor), std::move(found),
      shown.empty() ? text(msg::models_doctor_none, known) : shown);
}

Result<int> run(bool json) {
  Findings findings;
  add(findings, "mjarm", "mjarm", MJARM_VERSION, MJARM_VERSION);
  look_at_mujoco(findings);
  look_at_machine(findings);
  look_at_graphics(findings);
  look_at_fonts(findings);
  look_at_ffmpeg(findings);
  look_at_ompl(findings);
  look_at_apriltag(findings);
  look_at_space_mouse(findings);
  look_at_cache(findings);
  look_at_models(findings);
  look_at_meshes(findings);
  const bool fine = findings.problems.empty();
  if (json) {
    findings.facts.set("problems", findings.problems);
    findings.facts.set("ok", fine);
    print_lines(findings.facts.document());
  } else {
    print_lines(findings.lines);
    // Not all is well for somebody whose language no picture shows: the note says what to install.
    const bool shown = render::picture_language() == language();
    if (fine && shown) print_lines(text(msg::app_doctor_fine) + "\n");
  }
  for (const std::string& problem : findings.problems) log_error(problem);
  return fine ? 0 : 1;
}

Run setup(CLI::App& app) {
  auto json = std::make_shared<bool>(false);
  add_flag(app, "--json", *json, msg::app_option_json);
  return [json] { return run(*json); };
}

}  // namespace

Command doctor_command() {
  return {"doctor", msg::app_doctor_summary, msg::app_doctor_examples, setup};
}

}  // namespace mjarm::app
