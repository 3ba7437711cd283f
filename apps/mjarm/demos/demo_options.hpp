#pragma once

#include <string>
#include <vector>

#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/commands/page_options.hpp"
#include "apps/mjarm/demos/demos.hpp"

namespace mjarm::app {

/// Options of demos as the user wrote them.
struct DemoArguments {
  std::string out, seconds, text, control, robot, tip;
  std::string pos, to, from, euler, quat, seed_q, joints, ctrl, start;
  std::string center, normal, a, b, radius, height, seed;
  std::vector<std::string> package_paths, allow;
  bool headless = false, meshes = false, guide = false, video = false, no_timing = false,
       allow_outside = false;
  RunPageArguments pages;
  Replace replace;
};

/// Adds those options that a demo with these `uses` takes, bound to `arguments`.
/// @param uses  of DemoUse.
void add_demo_options(CLI::App& app, unsigned uses, DemoArguments& arguments);

/// Reads them.
/// @return a usage error for one that the demo does not use, since it would do nothing, and for
///         options that contradict each other; bad_input that names the option for a value.
[[nodiscard]] Result<DemoOptions> read_demo_options(const Demo& demo,
                                                    const DemoArguments& arguments);

}  // namespace mjarm::app
