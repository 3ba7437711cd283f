#include <cstdlib>
#include <optional>
#include <regex>

#include "mjarm/core/messages.hpp"
#include "mjarm/model/load_internal.hpp"
#include "mjarm/model/mujoco_guard.hpp"

namespace mjarm {
namespace fs = std::filesystem;
namespace {

/// MuJoCo's words taken apart.
struct Complaint {
  std::string what;
  std::string element;  ///< kind or name of the element, empty where MuJoCo names none
  int line = 0;         ///< 0 where MuJoCo names none
};

/// MuJoCo writes "[XML ]Error: WHAT\nElement 'KIND', line N" or "...\nElement name 'NAME', id I,
/// line N".
Complaint take_apart(std::string_view words) {
  Complaint result;
  const std::string all(words);
  static const std::regex place(R"(\n?Element (name )?'([^']*)'(, id -?\d+)?(, line (-?\d+))?)");
  std::smatch match;
  result.what = all;
  if (std::regex_search(all, match, place)) {
    result.what = match.prefix().str() + match.suffix().str();
    result.element = match[2].str();
    if (match[1].matched && !result.element.empty()) result.element = "\"" + result.element + "\"";
    if (!match[1].matched) result.element = "<" + result.element + ">";
    if (match[5].matched) result.line = std::max(0, std::atoi(match[5].str().c_str()));
  }
  for (bool again = true; again;) {
    again = false;
    for (const std::string_view prefix : {"XML Error: ", "Error: ", "Schema violation: "}) {
      if (!result.what.starts_with(prefix)) continue;
      result.what.erase(0, prefix.size());
      again = true;
    }
  }
  for (char& c : result.what) {
    if (c == '\n' || c == '\r' || c == '\t') c = ' ';
  }
  while (!result.what.empty() && result.what.back() == ' ') result.what.pop_back();
  return result;
}

Error complaint_error(const fs::path& file, std::string_view words) {
  const Complaint complaint = take_apart(words);
  std::string place = file.string();
  if (complaint.line > 0) place += ":" + std::to_string(complaint.line);
  if (complaint.element.empty()) {
    return {Errc::bad_input, text(Msg::model_refused, place, complaint.what)};
  }
  return {Errc::bad_input,
          text(Msg::model_element_refused, place, complaint.element, complaint.what)};
}

/// Makes and drops the scratch memory of `model`, to find out here whether it can be had.
std::optional<std::string> memory_fault(const mjModel* model) {
  const MujocoOutcome outcome = call_mujoco([&] { mj_deleteData(mj_makeData(model)); });
  if (!outcome.failed) return std::nullopt;
  return outcome.error;
}

}  // namespace

Result<LoadedModel> compile_spec(const SpecSource& source, void (*prepare)(mjSpec*)) {
  constexpr int kErrorSize = 2048;
  char error[kErrorSize] = "";
  mjSpec* parsed = nullptr;
  const std::string file = source.file.string();
  MujocoOutcome outcome = call_mujoco([&] {
    parsed = source.text != nullptr
                 ? mj_parseXMLString(source.text->c_str(), nullptr, error, kErrorSize)
                 : mj_parseXML(file.c_str(), nullptr, error, kErrorSize);
  });
  const MjSpecPtr spec(parsed);
  if (outcome.failed) return fail(complaint_error(source.file, outcome.error));
  if (spec == nullptr) return fail(complaint_error(source.file, error));
  LoadedModel loaded;
  loaded.warnings = std::move(outcome.warnings);
  if (prepare != nullptr) prepare(spec.get());

  mjModel* compiled = nullptr;
  outcome = call_mujoco([&] { compiled = mj_compile(spec.get(), nullptr); });
  loaded.model.reset(compiled);
  if (outcome.failed) return fail(complaint_error(source.file, outcome.error));
  if (compiled == nullptr) return fail(complaint_error(source.file, mjs_getError(spec.get())));
  for (std::string& warning : outcome.warnings) loaded.warnings.push_back(std::move(warning));
  for (int i = 0; i < mjs_numWarnings(spec.get()); ++i) {
    loaded.warnings.emplace_back(mjs_getWarning(spec.get(), i));
  }
  if (const std::optional<std::string> fault = memory_fault(compiled)) {
    return fail(complaint_error(source.file, *fault));
  }
  return loaded;
}

Result<LoadedModel> load_mjcf(const fs::path& file) {
  return compile_spec({.file = file}, nullptr);
}

}  // namespace mjarm
