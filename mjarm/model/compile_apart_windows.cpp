#include <cstdio>
#include <sstream>

#include "mjarm/core/messages/guard.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/os_child_program.hpp"
#include "mjarm/model/compile_apart_internal.hpp"
#include "mjarm/model/model_trial.hpp"

namespace mjarm {
namespace {

constexpr const char* kTrial = "--try-model";

/// The file and how it is meant, a line each, then the text that is parsed in its place.
std::string request(const SpecSource& source) {
  return source.name() + "\n" + (source.looks ? "looks" : "-") + "\n" +
         (source.text != nullptr ? "text" : "-") + "\n" +
         (source.text != nullptr ? *source.text : "");
}

std::string read_input() {
  std::string all;
  char piece[65536];
  std::size_t count = 0;
  while ((count = std::fread(static_cast<char*>(piece), 1, sizeof piece, stdin)) > 0) {
    all.append(static_cast<char*>(piece), count);
  }
  return all;
}

/// Tries a description out in a process that may crash, hang or run out of memory. What is done to
/// it afterwards is our own (`prepare`).
Result<void> try_apart(const SpecSource& source) {
  const Result<std::filesystem::path> self = executable_path();
  if (!self) return fail(self.error());
  const std::filesystem::path program = self->parent_path() / "mjarm.exe";
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(program, ignored)) {
    return fail(Errc::not_available, text(msg::guard_no_trial, source.name(), program.string()));
  }
  const Result<ChildResult> result =
      run_child_program(program, {kTrial}, request(source), kTrialLimits);
  if (!result) return fail(result.error());
  if (result->end == ChildEnd::done) return {};
  std::string_view said = result->said;
  return fail(bad_end(source, *result, take_stages(said)));
}

}  // namespace

Result<LoadedModel> compile_spec(const SpecSource& source) {
  if (!source.trusted) {
    if (Result<void> tried = try_apart(source); !tried) return fail(std::move(tried.error()));
  }
  return compile_here(source, nullptr);
}

/// What is wrong with a description is found again, and told, by whoever asked.
std::optional<int> model_trial(const std::vector<std::string>& arguments) {
  if (arguments != std::vector<std::string>{kTrial}) return std::nullopt;
  crash_silently();
  std::istringstream input(read_input());
  std::string name, looks, has_text;
  std::getline(input, name);
  std::getline(input, looks);
  std::getline(input, has_text);
  const std::string words(std::istreambuf_iterator<char>(input), {});
  const XmlSources files(name, true);  // where includes may lie was looked at before
  if (files.documents().empty()) return 0;
  const SpecSource source{
      .files = files, .text = has_text == "text" ? &words : nullptr, .looks = looks == "looks"};
  (void)compile_here(source, [](Stage stage) {
    std::fputc(static_cast<char>(stage), stdout);
    std::fflush(stdout);
  });
  return 0;
}

}  // namespace mjarm
