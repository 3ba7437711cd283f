#include "apps/mjarm/commands/model_export.hpp"

#include <cstdio>
#include <filesystem>
#include <system_error>

#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/model/export.hpp"

namespace mjarm::app {
namespace fs = std::filesystem;
namespace {

/// The format that was asked for, or the one whose files end like `out`.
Result<ExportFormat> format_of(const ExportOptions& options, const fs::path& out) {
  if (!options.to.empty()) return export_format(options.to);
  const std::string ending = out.extension().string();
  if (ending == ".xml" || ending == ".mjcf") return ExportFormat::mjcf;
  if (ending == ".urdf") return ExportFormat::urdf;
  if (ending == ".mjb") return ExportFormat::mjb;
  return fail(Errc::usage, text(msg::app_option_missing, "--to"));
}

}  // namespace

void add_export_options(CLI::App& app, ExportOptions& options) {
  add_option(app, "--to", options.to, msg::app_option_to, "FORMAT");
  add_option(app, "--out", options.out, msg::app_option_export_out, "FILE");
  add_overwrite_option(app, options.replace);
}

Result<int> run_export(const Model& model, const ExportOptions& options) {
  if (options.out.empty()) return fail(Errc::usage, text(msg::app_option_missing, "--out"));
  const fs::path out = options.out;
  const Result<ExportFormat> format = format_of(options, out);
  if (!format) return fail(format.error());
  std::error_code unknown;
  if (fs::equivalent(out, model.file(), unknown)) {
    return fail(Errc::usage, text(msg::app_export_over_input, out.string()));
  }
  const Result<LongResult> result = LongResult::begin(out, options.replace);
  if (!result) return fail(result.error());
  const Result<Exported> exported = export_model(model, *format, fs::absolute(out).parent_path());
  if (!exported) return fail(exported.error());
  if (auto written = write_file(out, exported->content); !written) return fail(written.error());
  result->made();
  for (const std::string& note : exported->notes) log_warning(note);
  std::printf("%s\n", out.string().c_str());
  return 0;
}

}  // namespace mjarm::app
