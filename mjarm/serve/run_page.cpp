#include "mjarm/serve/run_page.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "mjarm/core/base64.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/messages.hpp"
#include "mjarm/core/messages/serve.hpp"
#include "mjarm/core/sha256.hpp"
#include "mjarm/model/drawn_model.hpp"
#include "mjarm/serve/first_view_internal.hpp"
#include "mjarm/serve/live_messages.hpp"
#include "mjarm/serve/packed_run_internal.hpp"
#include "mjarm/serve/page_site.hpp"
#include "mjarm/serve/scene_json.hpp"

namespace mjarm::serve {
namespace {

constexpr std::string_view kStyleLink = "<link rel=\"stylesheet\" href=\"./page.css\">";
constexpr std::string_view kScriptLink = "<script type=\"module\" src=\"./page.js\"></script>";
constexpr std::string_view kHead = "<meta charset=\"utf-8\">";
constexpr std::string_view kEnd = "</body>";

/// The files of the page.
struct PageFiles {
  std::string index, style, script;
  std::string ik;  ///< the kinematics in WebAssembly; empty where they were not built
};

Result<PageFiles> page_files() {
  const std::optional<std::filesystem::path> folder = page_folder();
  if (!folder) return fail(Errc::not_available, text(msg::serve_no_page_for_file));
  PageFiles files;
  for (const auto& [name, content] : {std::pair{"index.html", &files.index},
                                      {"page.css", &files.style},
                                      {"page.js", &files.script}}) {
    Result<std::string> read = read_file(*folder / name);
    if (!read) return fail(std::move(read.error()));
    *content = std::move(*read);
  }
  if (Result<std::string> ik = read_file(*folder / "ik.wasm")) files.ik = std::move(*ik);
  const bool whole = std::ranges::all_of(
      std::vector{kStyleLink, kScriptLink, kHead, kEnd},
      [&files](std::string_view part) { return files.index.find(part) != std::string::npos; });
  if (!whole) return fail(Errc::not_available, text(msg::serve_other_page, folder->string()));
  return files;
}

/// JSON that may stand in an element `script`: nothing in it ends that.
std::string in_script(std::string json) {
  std::string out;
  for (const char c : json) c == '<' ? out += "\\u003c" : out += c;
  return out;
}

/// What the page is told of a run, but for what is packed.
std::string run_json(const view::RecordedRun& run, const DrawnModel& drawn,
                     const render::CameraView& view, std::span<const int> bodies, bool thinks) {
  const SceneFacts facts{.title = run.title,
                         .name = std::string(run.model.name()),
                         .language = language(),
                         .view = view,
                         .nq = run.model.nq(),
                         .can_push = false,
                         .can_target = thinks,
                         .can_lead = false,
                         .jog_dofs = thinks ? run.dofs : std::vector<int>()};
  BodyPoses last(run.model);
  std::string out;
  JsonWriter json(out);
  json.object().member("moments", run.bodies.size()).key("bodies").list();
  for (const int body : bodies) json.value(body);
  json.end_list().key("still").list();
  for (std::size_t body = 0; body < static_cast<std::size_t>(run.bodies.bodies()); ++body) {
    for (const double p : run.bodies.p_W(0).subspan(3 * body, 3)) json.value(p);
    for (const double part : run.bodies.quat(0).subspan(4 * body, 4)) json.value(part);
  }
  json.end_list().end_object();
  out.pop_back();
  out += ",\"scene\":" + scene_json(drawn, facts);
  out += ",\"overlay\":" + overlay_message(run.overlay, last);
  out += ",\"plots\":" + plots_message(run.plots);
  if (thinks) out += ",\"arm\":" + run.arm;
  return out + ",\"status\":" + status_message(run.line) + "}";
}

void replace(std::string& text, std::string_view part, std::string_view by) {
  text.replace(text.find(part), part.size(), by);
}

std::string hash_source(std::string_view content) {
  return "'sha256-" + base64(sha256_bytes(content)) + "'";
}

/// The page with everything in it.
std::string joined(PageFiles files, const std::string& run, const std::string& packed,
                   bool thinks) {
  const auto block = [](const char* type, const char* id, const std::string& content) {
    return std::string("<script type=\"") + type + "\" id=\"" + id + "\">" + content +
           "</script>\n";
  };
  const std::string policy = "default-src 'none'; script-src " + hash_source(files.script) +
                             " 'wasm-unsafe-eval'; style-src " + hash_source(files.style) +
                             "; img-src blob: data:; base-uri 'none'; form-action 'none'";
  std::string out = std::move(files.index);
  replace(out, kEnd,
          block("application/json", "run", in_script(run)) +
              block("text/plain", "run-bytes", base64(packed)) +
              (thinks ? block("text/plain", "ik-bytes", base64(deflated(files.ik))) : "") +
              std::string(kEnd));
  replace(out, kStyleLink, "<style>" + files.style + "</style>");
  replace(out, kScriptLink, "<script type=\"module\">" + files.script + "</script>");
  replace(out, kHead,
          std::string(kHead) + "\n<meta http-equiv=\"Content-Security-Policy\" content=\"" +
              policy + "\">");
  return out;
}

}  // namespace

Result<std::string> run_page(const view::RecordedRun& run) {
  Result<PageFiles> files = page_files();
  if (!files) return fail(std::move(files.error()));
  if (run.bodies.empty()) return fail(Errc::bad_input, text(msg::serve_nothing_recorded));
  const Result<render::CameraView> view = first_view(run.model, run.camera);
  if (!view) return fail(view.error());
  const DrawnModel drawn = drawn_model(run.model);
  const std::vector<int> bodies = moving_bodies(run.bodies);
  const bool thinks = !files->ik.empty() && !run.arm.empty();
  return joined(std::move(*files), run_json(run, drawn, *view, bodies, thinks),
                packed_run(drawn.meshes, run.bodies, bodies), thinks);
}

Result<void> write_run_page(const std::filesystem::path& file, const view::RecordedRun& run) {
  return run_page(run).and_then(
      [&file](const std::string& page) { return write_file(file, page); });
}

}  // namespace mjarm::serve
