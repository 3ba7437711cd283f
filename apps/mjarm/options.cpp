#include "apps/mjarm/options.hpp"

#include <CLI/CLI.hpp>

namespace mjarm::app {

void add_option(CLI::App& app, const char* name, std::string& value, Msg help, const char* type) {
  app.add_option(name, value, text(help))->type_name(type);
}

void add_option(CLI::App& app, const char* name, std::string& value, Msg help, const char* type,
                const char* bare) {
  app.add_option(name, value, text(help))->type_name(type)->expected(0, 1)->default_str(bare);
}

void add_option(CLI::App& app, const char* name, std::vector<std::string>& values, Msg help,
                const char* type) {
  app.add_option(name, values, text(help))->type_name(type)->take_all();
}

void add_flag(CLI::App& app, const char* name, bool& value, Msg help) {
  app.add_flag(name, value, text(help));
}

CLI::App& add_subcommand(CLI::App& parent, const std::string& name, Msg summary, Msg examples) {
  CLI::App& app = *parent.add_subcommand(name, text(summary));
  app.footer(text(examples));
  app.allow_extras();  // what is not known is reported by us, with the nearest right word
  app.fallthrough();   // global options may stand anywhere
  app.require_subcommand(0, 1);
  return app;
}

bool is_called(const CLI::App& app) { return app.parsed(); }

std::string name_of(const CLI::App& app) { return app.get_name(); }

}  // namespace mjarm::app
