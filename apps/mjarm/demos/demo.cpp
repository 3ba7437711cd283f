#include "apps/mjarm/messages/demo.hpp"

#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/commands/run_output.hpp"
#include "apps/mjarm/demos/demo_options.hpp"
#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/messages/train.hpp"
#include "mjarm/core/os.hpp"

namespace mjarm::app {
namespace {

void list_demos() {
  for (const Demo& demo : demos()) {
    std::printf("%-12s  %s\n", demo.name, text(demo.summary).c_str());
  }
}

Result<int> run_demo(const Demo& demo, const DemoArguments& arguments) {
  Result<DemoOptions> options = read_demo_options(demo, arguments);
  if (!options) return fail(options.error());
  const Result<RunPages> pages = read_run_pages(arguments.pages, options->headless);
  if (!pages) return fail(pages.error());
  options->record = pages->record;
  catch_interrupts();
  const Result<Report> report =
      beside_what_shows(*pages, options->headless, [&] { return demo.run(*options); });
  if (!report) return fail(report.error());
  return conclude(*report, options->out);
}

/// Each demo is a command with the options it takes, so that its help shows these; the options may
/// stand before the name as well.
Run setup(CLI::App& app) {
  auto arguments = std::make_shared<DemoArguments>();
  add_demo_options(app, ~0U, *arguments);
  std::vector<std::pair<const CLI::App*, const Demo*>> commands;
  for (const Demo& demo : demos()) {
    CLI::App& sub = add_subcommand(app, demo.name, demo.summary, {demo.examples, demo.examples});
    add_demo_options(sub, demo.uses, *arguments);
    commands.emplace_back(&sub, &demo);
  }
  return [arguments, commands]() -> Result<int> {
    for (const auto& [command, demo] : commands) {
      if (is_called(*command)) return run_demo(*demo, *arguments);
    }
    list_demos();
    return 0;
  };
}

}  // namespace

std::span<const Demo> demos() {
  constexpr unsigned kArm = kUseRobot | kUseFiles | kUseMeshes | kUseSeconds;
  constexpr unsigned kDriven = kArm | kUseControl;
  constexpr unsigned kGuided = kDriven | kUseGuide;
  constexpr unsigned kGoal = kUseTo | kUseOrientation | kUseSeed;
  static constexpr Demo kDemos[] = {
      {"car", msg::demo_about_car, run_car, kUseMeshes | kUseSeconds,
       "  mjarm demo car --headless"},
      {"ur5e", msg::demo_about_ur5e, run_ur5e, kDriven | kUseCtrl,
       "  mjarm demo ur5e --control servo_gravity\n"
       "  mjarm demo ur5e --ctrl -90deg,-90deg,90deg,-90deg,-90deg,0"},
      {"ur5e_vision", msg::demo_about_ur5e_vision, run_ur5e_vision, kDriven | kUseCtrl,
       "  mjarm demo ur5e_vision --seconds 2"},
      {"point", msg::demo_about_point, run_point, kArm | kUsePos | kUseOrientation | kUseSeed,
       "  mjarm demo point --headless\n"
       "  mjarm demo point --pos 0.3,-0.4,0.3 --euler 180deg,0,0"},
      {"movej", msg::demo_about_movej, run_movej, kGuided | kGoal | kUseJoints,
       "  mjarm demo movej --guide\n"
       "  mjarm demo movej --to 300mm,-0.4,0.3 --euler 180deg,0,0\n"
       "  mjarm demo movej --joints 0,-90deg,90deg,-90deg,-90deg,0"},
      {"movel", msg::demo_about_movel, run_movel, kGuided | kGoal | kUseFrom,
       "  mjarm demo movel --control servo\n"
       "  mjarm demo movel --from 0.3,-0.4,0.3 --to -0.3,-0.4,0.3 --euler 180deg,0,0"},
      {"ellipse", msg::demo_about_ellipse, run_ellipse,
       kGuided | kUsePlane | kUseAxes | kUseOrientation,
       "  mjarm demo ellipse --headless --video\n"
       "  mjarm demo ellipse --center 0.4,0,0.4 --a 0.2 --b 0.1 --normal 1,0,0\n"
       "  mjarm demo ellipse --radius 10cm"},
      {"letters", msg::demo_about_letters, run_letters,
       kDriven | kUseText | kUsePlane | kUseOrientation,
       "  mjarm demo letters --text HELLO\n"
       "  mjarm demo letters --text LZ --center 0,-0.45,0.3 --normal 0,0,1 --height 10cm"},
      {"calligraphy", msg::demo_about_calligraphy, run_calligraphy, kUseText | kUseSeconds,
       "  mjarm demo calligraphy --text 永字八法\n"
       "  mjarm demo calligraphy --text MJARM --height 6cm"},
      {"singularity", msg::demo_about_singularity, run_singularity, kDriven,
       "  mjarm demo singularity --headless"},
      {"flip", msg::demo_about_flip, run_flip, kDriven, "  mjarm demo flip --headless"},
      {"avoid", msg::demo_about_avoid, run_avoid, kUseRobot | kUseSeconds | kUseControl,
       "  mjarm demo avoid --tip ee_link"},
      {"pick_place", msg::demo_about_pick_place, run_pick_place,
       kUseRobot | kUseSeconds | kUseControl,
       "  mjarm demo pick_place --headless --video\n"
       "  mjarm demo pick_place --robot panda"},
      {"sort", msg::demo_about_sort, run_sort, kUseRobot | kUseSeconds | kUseControl | kUseDraw,
       "  mjarm demo sort --headless --video\n"
       "  mjarm demo sort --robot panda --seed 7"},
      {"square", msg::demo_about_square, run_square, kDriven | kUseAllow,
       "  mjarm demo square --robot my_arm.urdf"},
      {"reach", msg::train_about_reach, run_reach, 0, "  mjarm demo reach --headless"},
  };
  return kDemos;
}

Command demo_command() { return {"demo", msg::demo_summary, msg::demo_examples, setup}; }

}  // namespace mjarm::app
