#include "apps/mjarm/commands/page_options.hpp"

#include <cstdint>
#include <cstdio>
#include <filesystem>

#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/serve.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/serve/page_site.hpp"
#include "mjarm/serve/run_page.hpp"

namespace mjarm::app {
namespace {

/// Where a browser finds the page, as one line that is there at once, whoever reads it.
void tell_address(const std::string& url) {
  std::printf("%s\n", text(msg::serve_open, url).c_str());
  std::fflush(stdout);
}

Result<void> keep_run(const std::filesystem::path& file, const view::RecordedRun& run) {
  const std::filesystem::path folder = file.parent_path();
  Result<void> done = (folder.empty() ? Result<void>() : make_folder(folder)).and_then([&] {
    return serve::write_run_page(file, run);
  });
  if (done) log_info(text(msg::serve_html_written, file.string()));
  return done;
}

}  // namespace

void add_serve_options(CLI::App& app, ServeArguments& arguments) {
  add_option(app, "--port", arguments.port, msg::serve_option_port, "PORT");
  add_option(app, "--address", arguments.address, msg::serve_option_address, "ADDRESS");
}

Result<serve::PageOptions> read_serve_options(const ServeArguments& arguments) {
  serve::PageOptions page;
  page.on_open = tell_address;
  page.token = environment("MJARM_SERVE_TOKEN").value_or("");  // arguments are seen by everybody
  if (!arguments.address.empty()) page.server.address = arguments.address;
  if (arguments.port.empty()) return page;
  const Result<std::uint64_t> port = parse_whole("--port", arguments.port);
  if (!port) return fail(port.error());
  if (*port > 65535) return fail(Errc::usage, text(msg::serve_bad_port, *port));
  page.server.port = static_cast<int>(*port);
  return page;
}

void add_run_page_options(CLI::App& app, RunPageArguments& arguments) {
  add_flag(app, "--serve", arguments.serve, msg::serve_option_serve);
  add_option(app, "--port", arguments.port, msg::serve_option_port, "PORT");
  add_option(app, "--html", arguments.html, msg::serve_option_html, "FILE.html");
}

Result<RunPages> read_run_pages(const RunPageArguments& arguments, bool headless, bool waits) {
  RunPages pages;
  if (arguments.serve && headless) {
    return fail(Errc::usage, text(msg::app_exclusive_options, "--serve", "--headless"));
  }
  if (!arguments.serve && !arguments.port.empty()) {
    return fail(Errc::usage, text(msg::serve_port_alone));
  }
  if (arguments.serve) {
    Result<serve::PageOptions> page = read_serve_options({.address = {}, .port = arguments.port});
    if (!page) return fail(std::move(page.error()));
    page->waits = waits;
    pages.page = std::move(*page);
  }
  if (arguments.html.empty()) return pages;
  const std::filesystem::path file = arguments.html;
  if (file.extension() != ".html" && file.extension() != ".htm") {
    return fail(Errc::usage, text(msg::serve_no_html, arguments.html));
  }
  if (!serve::page_folder()) return fail(Errc::not_available, text(msg::serve_no_page_for_file));
  pages.record = [file](const view::RecordedRun& run) { return keep_run(file, run); };
  return pages;
}

}  // namespace mjarm::app
