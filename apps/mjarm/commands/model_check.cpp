#include "apps/mjarm/commands/model_check.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "apps/mjarm/cli/print.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/text_width.hpp"

namespace mjarm::app {
namespace fs = std::filesystem;
namespace {

std::string grade_word(Grade grade) {
  switch (grade) {
    case Grade::error:
      return text(msg::app_check_error);
    case Grade::warning:
      return text(msg::app_check_warning);
    case Grade::note:
      break;
  }
  return text(msg::app_check_note);
}

/// `ur5e.xml:71`, the file as seen from the folder of the main one.
std::string short_place(const Finding& finding, const fs::path& folder) {
  fs::path file = fs::path(finding.file).lexically_relative(folder);
  if (file.empty() || file.generic_string().starts_with("../../..")) file = finding.file;
  return finding.line > 0 ? file.string() + ":" + std::to_string(finding.line) : file.string();
}

/// `FILE:LINE: <element>: what`, for the one line on standard error.
std::string worst_line(const Finding& finding) {
  std::string line = finding.file;
  if (finding.line > 0) line += ":" + std::to_string(finding.line);
  if (finding.element.empty()) return text(msg::app_check_worst, line, finding.what);
  return text(msg::app_check_worst_element, line, finding.element, finding.what);
}

/// Refuses what could not be written, before anything is measured.
Result<std::optional<LongResult>> begin_fix(const fs::path& file, const FixOptions& fix) {
  if (fix.out.empty()) return std::optional<LongResult>();
  if (fs::path(fix.out).extension() != ".xml") {
    return fail(Errc::usage, text(msg::app_fix_ending, fix.out));
  }
  std::error_code unknown;
  if (fs::equivalent(fix.out, file, unknown)) {
    return fail(Errc::usage, text(msg::app_fix_over_input, fix.out));
  }
  Result<LongResult> result = LongResult::begin(fix.out, fix.replace);
  if (!result) return fail(result.error());
  return std::optional<LongResult>(std::move(*result));
}

Result<void> write_fix(const fs::path& file, const CheckOptions& options, const GripMend& mend,
                       const LongResult& result, const std::string& out) {
  const Result<Model> model = Model::load(file, options.load);
  if (!model) return fail(model.error());
  const Result<Exported> exported = export_mended(*model, mend, fs::absolute(out).parent_path());
  if (!exported) return fail(exported.error());
  if (auto written = write_file(out, exported->content); !written) return fail(written.error());
  result.made();
  // All that MJCF cannot take along.
  if (!exported->notes.empty()) log_warning(text(msg::app_fix_files_stay, out));
  return {};
}

}  // namespace

std::string to_text(const CheckReport& report) {
  const fs::path folder = fs::path(report.file).parent_path();
  int grade_width = 0;
  int place_width = 0;
  for (const Finding& finding : report.findings) {
    grade_width = std::max(grade_width, text_width(grade_word(finding.grade)));
    place_width = std::max(place_width, text_width(short_place(finding, folder)));
  }
  std::string result = report.file + "\n";
  for (const Finding& finding : report.findings) {
    result += "  " + padded(grade_word(finding.grade), grade_width + 2) +
              padded(short_place(finding, folder), place_width + 2);
    if (!finding.element.empty()) result += finding.element + "  ";
    result += finding.what + "  [" + std::string(name(finding.code)) + "]\n";
  }
  const int errors = report.count(Grade::error);
  const int warnings = report.count(Grade::warning);
  const int notes = report.count(Grade::note);
  return result +
         (errors + warnings > 0 ? text(msg::app_check_counts, errors, warnings, notes)
                                : text(msg::app_check_fine, notes)) +
         "\n";
}

std::string to_json(const CheckReport& report) {
  std::vector<JsonDoc> findings;
  for (const Finding& finding : report.findings) {
    findings.push_back({{"code", name(finding.code)},
                        {"grade", name(finding.grade)},
                        {"file", finding.file},
                        {"line", finding.line > 0 ? JsonDoc(finding.line) : JsonDoc(nullptr)},
                        {"element", finding.element},
                        {"message", finding.what}});
  }
  const JsonDoc json{{"file", report.file},
                     {"ok", report.count(Grade::error) == 0},
                     {"loads", report.loads},
                     {"errors", report.count(Grade::error)},
                     {"warnings", report.count(Grade::warning)},
                     {"notes", report.count(Grade::note)},
                     {"findings", std::move(findings)}};
  return json.document();
}

Result<int> check_file(const fs::path& file, const CheckOptions& options, bool json,
                       const FixOptions& fix) {
  const Result<std::optional<LongResult>> result = begin_fix(file, fix);
  if (!result) return fail(result.error());
  const Result<CheckReport> report = check_model(file, options);
  if (!report) return fail(report.error());
  const std::string words = json ? to_json(*report) : to_text(*report);
  print_lines(words);
  if (result->has_value() && report->grip_mend.empty()) {
    if (report->loads) log_info(text(msg::app_fix_nothing, file.string(), fix.out));
  } else if (result->has_value()) {
    auto done = write_fix(file, options, report->grip_mend, **result, fix.out);
    if (!done) return fail(done.error());
    log_info(text(msg::app_fix_written, fix.out));
  }
  if (report->count(Grade::error) == 0) return 0;
  return fail(report->loads ? Errc::impossible : Errc::bad_input,
              worst_line(report->findings.front()));
}

}  // namespace mjarm::app
