#include "mjarm/model/model.hpp"

#include <memory>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/print.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/commands/model_check.hpp"
#include "apps/mjarm/commands/model_export.hpp"
#include "apps/mjarm/commands/model_report.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/program_name.hpp"

namespace mjarm::app {
namespace {

struct Options {
  std::string file, tip, against;
  std::vector<std::string> package_paths;
  bool json = false;
  ExportOptions export_to;
  FixOptions fix;
  bool allow_outside = false;
};

void add_file_options(CLI::App& app, Options& options) {
  add_option(app, "file", options.file, msg::app_model_file, "FILE");
  add_package_path_option(app, options.package_paths);
}

void add_options(CLI::App& app, Options& options) {
  add_file_options(app, options);
  add_flag(app, "--json", options.json, msg::app_option_json);
  add_outside_option(app, options.allow_outside);
}

LoadOptions load_options(const Options& options) {
  return {.package_paths = {options.package_paths.begin(), options.package_paths.end()},
          .allow_outside = options.allow_outside};
}

Result<Model> load(const Options& options) {
  if (options.file.empty()) return fail(Errc::usage, text(msg::app_option_missing, "FILE"));
  const Result<std::filesystem::path> file = find_model_file(options.file);
  if (!file) return fail(file.error());
  Result<Model> model = Model::load(*file, load_options(options));
  if (!model) return model;
  for (const std::string& warning : model->warnings()) log_warning(warning);
  return model;
}

Result<int> run_info(const Options& options) {
  const Result<Model> model = load(options);
  if (!model) return fail(model.error());
  const Result<Arm> arm = find_arm(*model, {.tip = options.tip});
  // A car has no arm, and still there is much to tell about it; but a tip that was asked for must
  // be.
  if (!arm && !options.tip.empty()) return fail(arm.error());
  const ModelReport report = model_report(*model, arm);
  print_lines(options.json ? to_json(report) : to_text(report));
  return 0;
}

Result<int> run_tree(const Options& options) {
  const Result<Model> model = load(options);
  if (!model) return fail(model.error());
  const ModelInfo contents = describe(*model);
  print_lines(options.json ? tree_json(contents) : tree_text(contents));
  return 0;
}

Result<int> run_check(const Options& options) {
  if (options.file.empty()) return fail(Errc::usage, text(msg::app_option_missing, "FILE"));
  const Result<std::filesystem::path> file = find_model_file(options.file);
  if (!file) return fail(file.error());
  const CheckOptions check{.tip = options.tip, .load = load_options(options)};
  if (options.against.empty()) return check_file(*file, check, options.json, options.fix);
  if (!options.fix.out.empty()) {
    return fail(Errc::usage, text(msg::app_exclusive_options, "--against", "--fix"));
  }
  const Result<std::filesystem::path> other = find_model_file(options.against);
  if (!other) return fail(other.error());
  return check_against(*file, *other, check, options.json);
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App& info =
      add_subcommand(app, "info", msg::app_model_info_summary, msg::app_model_info_examples);
  add_options(info, *options);
  add_option(info, "--tip", options->tip, msg::app_option_tip, "FRAME");
  CLI::App& tree =
      add_subcommand(app, "tree", msg::app_model_tree_summary, msg::app_model_tree_examples);
  add_options(tree, *options);
  CLI::App& check =
      add_subcommand(app, "check", msg::app_model_check_summary, msg::app_model_check_examples);
  add_options(check, *options);
  add_option(check, "--tip", options->tip, msg::app_option_tip, "FRAME");
  add_option(check, "--against", options->against, msg::app_model_against, "FILE");
  add_option(check, "--fix", options->fix.out, msg::app_option_fix, "OUT.xml");
  add_overwrite_option(check, options->fix.replace);
  CLI::App& export_to =
      add_subcommand(app, "export", msg::app_model_export_summary, msg::app_model_export_examples);
  add_file_options(export_to, *options);
  add_export_options(export_to, options->export_to);
  return [options, &info, &tree, &check, &export_to]() -> Result<int> {
    if (is_called(info)) return run_info(*options);
    if (is_called(tree)) return run_tree(*options);
    if (is_called(check)) return run_check(*options);
    if (is_called(export_to)) {
      const Result<Model> model = load(*options);
      return model ? run_export(*model, options->export_to) : fail(model.error());
    }
    return fail(Errc::usage, text(msg::app_no_subcommand, program_name() + " model",
                                  "info, tree, check, export"));
  };
}

}  // namespace

Command model_command() {
  return {"model", msg::app_model_summary, msg::app_model_examples, setup};
}

}  // namespace mjarm::app
