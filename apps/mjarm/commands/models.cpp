#include "apps/mjarm/messages/models.hpp"

#include <cstdio>
#include <functional>
#include <memory>
#include <vector>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/install.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/program_name.hpp"
#include "mjarm/core/text_width.hpp"
#include "mjarm/core/user_data.hpp"
#include "mjarm/install/hanzi_package.hpp"
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

constexpr const char* kHanzi = "hanzi";

/// What was named, each once; the meshes of all robots where nothing is, and to be listed strokes
/// as well.
struct Chosen {
  std::vector<const install::MeshSet*> sets;
  bool hanzi = false;
};

Result<Chosen> chosen(const Options& options) {
  Chosen out;
  out.hanzi = options.names.empty() && options.list;
  std::vector<std::string> known;
  for (const install::MeshSet& set : install::mesh_sets()) {
    known.push_back(set.robot);
    if (options.names.empty()) out.sets.push_back(&set);
  }
  known.emplace_back(kHanzi);
  for (const std::string& name : options.names) {
    if (std::ranges::find(known, name) == known.end()) {
      return fail(Errc::usage,
                  text(msg::models_unknown, name, listed(known)) + did_you_mean(name, known));
    }
    if (name == kHanzi) {
      out.hanzi = true;
      continue;
    }
    const install::MeshSet* set = install::find_mesh_set(name).value();
    if (std::ranges::find(out.sets, set) == out.sets.end()) out.sets.push_back(set);
  }
  return out;
}

std::string_view name(install::InstallState::Kind kind) {
  constexpr std::string_view kNames[] = {"absent", "damaged", "outdated", "whole"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::string words(install::InstallState::Kind kind) {
  constexpr Msg kWords[] = {msg::models_state_absent, msg::models_state_damaged,
                            msg::models_state_outdated, msg::models_state_whole};
  return text(kWords[static_cast<std::size_t>(kind)]);
}

/// What is installed, as it is shown and written.
struct Listing {
  std::vector<JsonDoc> entries;
  std::string lines;
  std::string worst;  ///< the first fault

  void add(const std::string& what, const install::InstallState& state, const fs::path& folder,
           JsonDoc entry) {
    entries.push_back(std::move(entry));
    lines += padded(what, 8) + padded(words(state.kind), 16) + folder.string() + "\n";
    if (worst.empty() && !state.problem.empty()) {
      worst = text(msg::install_mend, state.problem, what);
    }
  }
};

Result<int> run_list(const Chosen& what, bool json) {
  Listing listing;
  for (const install::MeshSet* set : what.sets) {
    const Result<install::Installed> found = install::look_up(*set);
    if (!found) return fail(found.error());
    const install::InstallState& state = found->state;
    listing.add(set->robot, state, found->folder,
                {{"robot", set->robot},
                 {"state", name(state.kind)},
                 {"folder", found->folder.string()},
                 {"meshes", set->files.size()},
                 {"licence", set->licence},
                 {"problem", state.problem}});
  }
  if (what.hanzi) {
    const Result<fs::path> data = data_folder();
    if (!data) return fail(data.error());
    const install::HanziPackage package;
    const install::InstallState state = install::check_hanzi(*data, package);
    const fs::path folder = install::hanzi_folder(*data);
    listing.add(kHanzi, state, folder,
                {{"strokes", kHanzi},
                 {"state", name(state.kind)},
                 {"folder", folder.string()},
                 {"characters", package.characters},
                 {"licence", package.licence},
                 {"problem", state.problem}});
  }
  const std::string shown =
      json ? JsonDoc(std::move(listing.entries)).document() : std::move(listing.lines);
  std::fputs(shown.c_str(), stdout);
  if (listing.worst.empty()) return 0;
  log_error(listing.worst);
  return 1;
}

Result<int> run_remove(const Chosen& what) {
  const Result<fs::path> data = data_folder();
  if (!data) return fail(data.error());
  std::error_code ignored;
  const bool any_there = fs::exists(*data, ignored);
  std::optional<FolderLock> lock;
  if (any_there) {
    Result<FolderLock> locked = install::lock_data_folder(*data);
    if (!locked) return fail(std::move(locked.error()));
    lock.emplace(std::move(*locked));
  }
  const auto say = [](const std::string& name, const Result<bool>& removed) -> Result<void> {
    if (!removed) return fail(removed.error());
    const Msg said = *removed ? msg::models_removed : msg::models_nothing_to_remove;
    std::printf("%s\n", text(said, name).c_str());
    return {};
  };
  for (const install::MeshSet* set : what.sets) {
    const auto removed = any_there ? install::remove_meshes(*data, *set) : Result<bool>(false);
    if (auto said = say(set->robot, removed); !said) return fail(said.error());
  }
  if (what.hanzi) {
    const auto removed = any_there ? install::remove_hanzi(*data) : Result<bool>(false);
    if (auto said = say(kHanzi, removed); !said) return fail(said.error());
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

/// What is there and whole stays as it is.
/// @param install  gives the line that is said then.
Result<void> install_one(const std::string& name, const install::InstallState& before,
                         const fs::path& folder,
                         const std::function<Result<std::string>()>& install) {
  if (before.kind == install::InstallState::Kind::whole) {
    std::printf("%s\n", text(msg::models_already, name, folder.string()).c_str());
    return {};
  }
  if (!before.problem.empty()) log_info(text(msg::models_mending, before.problem));
  const Result<std::string> done = install();
  if (!done) return fail(done.error());
  std::printf("%s\n", done->c_str());
  return {};
}

Result<void> install_robot(const install::MeshSet& set, const install::IndexSettings& index,
                           const std::string& from) {
  const Result<install::Installed> before = install::look_up(set);
  if (!before) return fail(before.error());
  return install_one(set.robot, before->state, before->folder, [&] {
    return install::install_meshes(before->data, set, before->scene, index, from).transform([&] {
      return text(msg::models_done, set.robot, set.files.size(), set.licence,
                  before->folder.string());
    });
  });
}

Result<void> install_strokes(const fs::path& data, const install::HttpOptions& http,
                             const std::string& from) {
  const install::HanziPackage package;
  const fs::path folder = install::hanzi_folder(data);
  return install_one(kHanzi, install::check_hanzi(data, package), folder, [&] {
    return install::install_hanzi(data, http, from, package).transform([&] {
      return text(msg::models_hanzi_done, package.characters, package.project, package.licence,
                  folder.string());
    });
  });
}

Result<int> run_install(const Chosen& what, const Options& options) {
  const install::IndexSettings index = install::index_settings();
  const Result<std::string> from = address_of(options.from);
  if (!from) return fail(from.error());
  const Result<fs::path> data = data_folder();
  if (!data) return fail(data.error());
  const Result<FolderLock> lock = install::lock_data_folder(*data);
  if (!lock) return fail(lock.error());
  for (const install::MeshSet* set : what.sets) {
    if (auto done = install_robot(*set, index, *from); !done) return fail(std::move(done.error()));
  }
  if (what.hanzi) {
    if (auto done = install_strokes(*data, index.http, *from); !done) return fail(done.error());
  }
  return 0;
}

Result<int> run(const Options& options) {
  const char* first = options.list ? "--list" : options.remove ? "--remove" : "";
  const char* second = options.list && options.remove ? "--remove" : "--from";
  if (*first != '\0' && ((options.list && options.remove) || !options.from.empty())) {
    return fail(Errc::usage, text(msg::app_exclusive_options, first, second));
  }
  const Result<Chosen> what = chosen(options);
  if (!what) return fail(what.error());
  if (options.list) return run_list(*what, options.json);
  if (options.remove) return run_remove(*what);
  return run_install(*what, options);
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
    return fail(Errc::usage, text(msg::app_no_subcommand, program_name() + " models", "install"));
  };
}

}  // namespace

Command models_command() { return {"models", msg::models_summary, msg::models_examples, setup}; }

}  // namespace mjarm::app
