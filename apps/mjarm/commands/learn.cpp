#include "apps/mjarm/messages/learn.hpp"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>
#include <vector>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/print.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/learn/learn_pages.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/os.hpp"

namespace mjarm::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string page, file, python;
  RobotChoice robot{.looks = false};
  bool json = false;
};

/// Name of the file of a page in the language in use.
std::string page_file(const LearnPage& page) {
  return std::string(page.name) + (language() == Language::chinese ? ".zh-CN.md" : ".md");
}

/// The folder of the pages: above that of the models, as in a clone; else its name in one.
fs::path page_folder() {
  const fs::path inside = fs::path("docs") / "learn";
  const Result<fs::path> scene = find_model_file("ur5e");
  if (!scene) return inside;
  std::error_code unknown;
  for (fs::path above = scene->parent_path(); above.has_relative_path();
       above = above.parent_path()) {
    const fs::path folder = above / inside;
    const std::string first = std::string(learn_pages().front().name) + ".md";
    if (fs::exists(folder / first, unknown)) return folder;
  }
  return inside;
}

Result<int> list_pages(const Options& options) {
  const fs::path folder = page_folder();
  std::vector<JsonDoc> docs;
  std::string lines = text(msg::learn_list_head, folder.string()) + '\n';
  int number = 0;
  for (const LearnPage& page : learn_pages()) {
    const std::string file = (folder / page_file(page)).string();
    ++number;
    docs.push_back({{"page", number},
                    {"title", text(page.title)},
                    {"about", text(page.about)},
                    {"file", file}});
    lines +=
        text(msg::learn_list_line, number, text(page.title), text(page.about), page_file(page)) +
        '\n';
  }
  lines += text(msg::learn_list_foot) + '\n';
  print_lines(options.json ? JsonDoc{{"pages", std::move(docs)}}.document() : lines);
  return 0;
}

Msg word_of(LearnLine::Kind kind) {
  switch (kind) {
    case LearnLine::Kind::right:
      return msg::learn_right;
    case LearnLine::Kind::wrong:
      return msg::learn_wrong;
    case LearnLine::Kind::note:
      break;
  }
  return msg::learn_note;
}

const char* name_of(LearnLine::Kind kind) {
  return kind == LearnLine::Kind::right   ? "right"
         : kind == LearnLine::Kind::wrong ? "wrong"
                                          : "note";
}

/// One line a finding; the last one is the verdict, on standard error where all is not right.
Result<int> tell(const LearnReport& report, std::size_t number, const Exercise& exercise,
                 bool json) {
  const std::size_t wrong = report.wrong_count();
  std::vector<JsonDoc> docs;
  std::string lines;
  for (const LearnLine& line : report.lines()) {
    docs.push_back({{"kind", name_of(line.kind)}, {"what", line.what}});
    lines += text(word_of(line.kind), line.what) + '\n';
  }
  if (wrong == 0) lines += text(msg::learn_all_right, number) + '\n';
  print_lines(json ? JsonDoc{{"page", number},
                             {"file", exercise.file},
                             {"ok", wrong == 0},
                             {"findings", std::move(docs)}}
                         .document()
                   : lines);
  std::fflush(stdout);  // the verdict comes last
  if (wrong == 0) return 0;
  return fail(Errc::impossible,
              exercise.file.empty()
                  ? text(msg::learn_not_right_yet, number, wrong)
                  : text(msg::learn_file_not_right_yet, exercise.file, number, wrong));
}

/// Pages with other exercises take no robot and no Python.
Result<void> fits(const Options& options, std::size_t number) {
  const bool robot = number == 3 || number == 5, python = number >= 8;
  if (!robot && !(options.robot.robot.empty() && options.robot.tip.empty())) {
    return fail(Errc::usage, text(msg::learn_not_for, "--robot", "3, 5"));
  }
  if (!python && !options.python.empty()) {
    return fail(Errc::usage, text(msg::learn_not_for, "--python", "8, 9"));
  }
  return {};
}

Result<int> check(const Options& options) {
  const auto pages = learn_pages();
  if (options.page.empty()) return fail(Errc::usage, text(msg::learn_which_page, pages.size()));
  const Result<std::uint64_t> number = parse_whole("N", options.page);
  if (!number) return fail(number.error());
  if (*number < 1 || *number > pages.size()) {
    return fail(Errc::usage, text(msg::learn_which_page, pages.size()));
  }
  const LearnPage& page = pages[static_cast<std::size_t>(*number - 1)];
  const auto index = static_cast<std::size_t>(*number);
  if (Result<void> fine = fits(options, index); !fine) return fail(fine.error());
  const bool given = !options.file.empty();
  const Exercise exercise{.file = given ? options.file : page.file,
                          .given = given,
                          .robot = options.robot,
                          .python = options.python};
  std::error_code unknown;
  if (!exercise.file.empty() && !fs::exists(exercise.file, unknown)) {
    return fail(Errc::bad_input, text(msg::learn_missing, exercise.file, text(page.how)));
  }
  catch_interrupts();
  const Result<LearnReport> report = page.check(exercise);
  if (!report) {
    Error error = report.error();
    // What cannot be looked at is not wrong: exit code 2.
    if (error.code != Errc::usage) error.code = Errc::bad_input;
    return fail(error);
  }
  return tell(*report, index, exercise, options.json);
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_flag(app, "--json", options->json, msg::app_option_json);
  CLI::App& sub = add_subcommand(app, "check", msg::learn_check_summary, msg::learn_check_examples);
  add_option(sub, "page", options->page, msg::learn_option_page, "N");
  add_option(sub, "file", options->file, msg::learn_option_file, "FILE");
  add_robot_options(sub, options->robot);
  add_option(sub, "--python", options->python, msg::learn_option_python, "PROGRAM");
  add_flag(sub, "--json", options->json, msg::app_option_json);
  return [options, &sub] { return is_called(sub) ? check(*options) : list_pages(*options); };
}

}  // namespace

Command learn_command() { return {"learn", msg::learn_summary, msg::learn_examples, setup}; }

}  // namespace mjarm::app
