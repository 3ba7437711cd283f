#include <filesystem>
#include <system_error>

#include "apps/mjarm/learn/exercise.hpp"
#include "apps/mjarm/learn/json_file.hpp"
#include "apps/mjarm/learn/python_planner.hpp"
#include "apps/mjarm/messages/learn.hpp"

namespace mjarm::app {
namespace {

namespace fs = std::filesystem;

constexpr double kLearnedShare = 0.9;  // of goals within 2 cm

bool is_there(const fs::path& file) {
  std::error_code unknown;
  return fs::exists(file, unknown);
}

/// The report that the reader names, else that of the page's own trainings.
std::string training_report(const Exercise& exercise) {
  if (exercise.given) {
    const fs::path inside = fs::path(exercise.file) / "report.json";
    return is_there(inside) ? inside.string() : exercise.file;
  }
  for (const char* const folder : {"second", "first"}) {
    const fs::path file = fs::path(folder) / "report.json";
    if (is_there(file)) return file.string();
  }
  return {};
}

Result<LearnReport> check_training(const Exercise& exercise) {
  const std::string file = training_report(exercise);
  if (file.empty()) return fail(Errc::bad_input, text(msg::learn_training_missing));
  const Result<JsonObject> object = read_json_file(file);
  if (!object) return fail(object.error());
  const JsonValue& report = **object;
  const JsonValue* const within = report.find("within");
  if (!word_in(report, "name").starts_with("train") || within == nullptr || !within->is_object()) {
    return fail(Errc::bad_input, text(msg::learn_no_training, file));
  }
  LearnReport out;
  const double share = number_in(*within, "2cm");
  const std::string line = text(msg::learn_training_share, file, number_in(report, "steps"),
                                100 * share, 100 * number_in(*within, "5mm"));
  if (share >= kLearnedShare) {
    out.right(line);
    out.note(text(msg::learn_training_next));
  } else {
    out.wrong(line);
    out.note(text(msg::learn_training_longer));
  }
  return out;
}

}  // namespace

Result<LearnReport> check_policy_or_rrt(const Exercise& exercise) {
  const bool python = fs::path(exercise.file).extension() == ".py";
  return python ? check_python_planner(exercise) : check_training(exercise);
}

}  // namespace mjarm::app
