#include "apps/mjarm/messages/models.hpp"

#include <cstdio>
#include <memory>
#include <vector>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/install.hpp"
#include "mjarm/core/text_width.hpp"
#include "mjarm/install/install.hpp"
#include "mjarm/install/installed.hpp"

namespace mjarm::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::vector<std::string> names;
  std::string from;
  bool list = false, remove = false, json = false;
};

/// The meshes named, each once; all where none is named.
Result<std::vector<const install::MeshSet*>> chosen(const Options& options) {
  std::vector<const install::MeshSet*> sets;
  for (const install::MeshSet& set : install::mesh_sets()) {
    if (options.names.empty()) sets.push_back(&set);
  }
  for (const std::string& name : options.names) {
    const Result<const install::MeshSet*> set = install::find_mesh_set(name);
    if (!set) return fail(set.error());
    if (std::find(sets.begin(), sets.end(), *set) == sets.end()) sets.push_back(*set);
  }
  return sets;
}

std::string_view name(install::MeshState::Kind kind) {
  constexpr std::string_view kNames[] = {"absent", "damaged", "outdated", "whole"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::string words(install::MeshState::Kind kind) {
  constexpr Msg kWords[] = {msg::models_state_absent, msg::models_state_damaged,
                            msg::models_state_outdated, msg::models_state_whole};
  return text(kWords[static_cast<std::size_t>(kind)]);
}

Result<int> run_list(const std::vector<const install::MeshSet*>& sets, bool json) {
  std::vector<JsonDoc> entries;
  std::string lines, worst;
  for (const install::MeshSet* set : sets) {
    const Result<install::Installed> found = install::look_up(*set);
    if (!found) return fail(found.error());
    const install::MeshState& state = found->state;
    entries.push_back({{"robot", set->robot},
                       {"state", name(state.kind)},
                       {"folder", found->folder.string()},
                       {"meshes", set->files.size()},
                       {"licence", set->licence},
                       {"problem", state.problem}});
    lines += padded(set->robot, 8) + padded(words(state.kind), 16) + found->folder.string() + "\n";
    if (worst.empty() && !state.problem.empty()) {
      worst = text(msg::install_mend, state.problem, set->robot);
    }
  }
  std::fputs((json ? JsonDoc(std::move(entries)).document() : lines).c_str(), stdout);
  if (worst.empty()) return 0;
  log_error(worst);
  return 1;
}

Result<int> run_remove(const std::vector<const install::MeshSet*>& sets) {
  const Result<fs::path> data = install::data_folder();
  if (!data) return fail(data.error());
  std::error_code ignored;
  const bool any_there = fs::exists(*data, ignored);
  std::optional<FolderLock> lock;
  if (any_there) {
    Result<FolderLock> locked = install::lock_data_folder(*data);
    if (!locked) return fail(std::move(locked.error()));
    lock.emplace(std::move(*locked));
  }
  for (const install::MeshSet* set : sets) {
    const Result<bool> removed =
        any_there ? install::remove_meshes(*data, *set) : Result<bool>(false);
    if (!removed) return fail(removed.error());
    const Msg said = *removed ? msg::models_removed : msg::models_nothing_to_remove;
    std::printf("%s\n", text(said, set->robot).c_str());
  }
  return 0;
}

/// What `--from` names, as the address of a folder; empty where it was not given.
Result<std::string> address_of(const std::string& from) {
  const bool url = from.find("://") != std::string::npos;
  if (from.empty() || url) {
    return from.ends_with('/') ? from.substr(0, from.size() - 1) : from;
  }
  std::error_code ignored;
  if (!fs::is_directory(from, ignored)) {
    return fail(Errc::bad_input, "--from: " + text(msg::core_no_such_folder, from));
  }
  return install::file_url(from);
}

Result<void> install_one(const install::MeshSet& set, const install::IndexSettings& index,
                         const std::string& from) {
  const Result<install::Installed> before = install::look_up(set);
  if (!before) return fail(before.error());
  if (before->state.kind == install::MeshState::Kind::whole) {
    std::printf("%s\n", text(msg::models_already, set.robot, before->folder.string()).c_str());
    return {};
  }
  if (!before->state.problem.empty()) {
    log_info(text(msg::models_mending, before->state.problem));
  }
  if (auto done = install::install_meshes(before->data, set, before->scene, index, from); !done)
    return done;
  std::printf("%s\n", text(msg::models_done, set.robot, set.files.size(), set.licence,
                           before->folder.string())
                          .c_str());
  return {};
}

Result<int> run_install(const std::vector<const install::MeshSet*>& sets, const Options& options) {
  const install::IndexSettings index = install::index_settings();
  const Result<std::string> from = address_of(options.from);
  if (!from) return fail(from.error());
  const Result<fs::path> data = install::data_folder();
  if (!data) return fail(data.error());
  const Result<FolderLock> lock = install::lock_data_folder(*data);
  if (!lock) return fail(lock.error());
  for (const install::MeshSet* set : sets) {
    if (auto done = install_one(*set, index, *from); !done) return fail(std::move(done.error()));
  }
  return 0;
}

Result<int> run(const Options& options) {
  const char* first = options.list ? "--list" : options.remove ? "--remove" : "";
  const char* second = options.list && options.remove ? "--remove" : "--from";
  if (*first != '\0' && ((options.list && options.remove) || !options.from.empty())) {
    return fail(Errc::usage, text(msg::app_exclusive_options, first, second));
  }
  const Result<std::vector<const install::MeshSet*>> sets = chosen(options);
  if (!sets) return fail(sets.error());
  if (options.list) return run_list(*sets, options.json);
  if (options.remove) return run_remove(*sets);
  return run_install(*sets, options);
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App& command =
      add_subcommand(app, "install", msg::models_install_summary, msg::models_install_examples);
  add_option(command, "names", options->names, msg::models_option_names, "[NAME...]");
  add_flag(command, "--list", options->list, msg::models_option_list);
  add_flag(command, "--remove", options->remove, msg::models_option_remove);
  add_option(command, "--from", options->from, msg::models_option_from, "DIR_OR_URL");
  add_flag(command, "--json", options->json, msg::app_option_json);
  return [options, &command]() -> Result<int> {
    if (is_called(command)) return run(*options);
    return fail(Errc::usage, text(msg::app_no_subcommand, "mjarm models", "install"));
  };
}

}  // namespace

Command models_command() { return {"models", msg::models_summary, msg::models_examples, setup}; }

}  // namespace mjarm::app
