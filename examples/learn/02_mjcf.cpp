// A box hangs in the air until its body has a joint. Which joint says how it may move.
#include <cmath>
#include <cstdio>
#include <string>

#include "mjarm/model/model.hpp"
#include "mjarm/sim/sim.hpp"

namespace {

std::string hello(const std::string& joint) {
  return R"(<mujoco model="hello">
  <worldbody>
    <geom name="floor" type="plane" size="5 5 0.1"/>
    <body name="box" pos="0 0 2">
      )" +
         joint +
         R"(
      <geom name="box" type="box" size="0.5 0.5 0.5" density="500"/>
    </body>
  </worldbody>
</mujoco>)";
}

/// Height of the box's middle [m] after `seconds`; NaN where something went wrong.
double height(const std::string& joint, double seconds) {
  const auto model = mjarm::Model::from_mjcf(hello(joint));
  if (!model) return std::fprintf(stderr, "%s\n", model.error().what.c_str()), NAN;
  mjarm::Sim sim(*model);
  while (sim.time() < seconds - 1e-9) {
    if (const auto step = sim.step({}); !step) return NAN;
  }
  return sim.body_pose(1).p.z();  // body 0 is the world
}

}  // namespace

int main() {
  const double hangs = height("", 0.5);
  const double falls = height("<freejoint/>", 0.5);
  const double lies = height("<freejoint/>", 2);
  const double turns = height(R"(<joint axis="0 1 0"/>)", 0.5);
  const double swings = height(R"(<joint axis="0 1 0" pos="-1 0 0"/>)", 0.5);
  std::printf("no joint %.3f m, free joint %.3f m, on the floor %.3f m\n", hangs, falls, lies);
  std::printf("hinge through the middle %.3f m, hinge 1 m beside it %.3f m\n", turns, swings);
  std::printf("2 - g t^2 / 2 = %.3f m\n", 2 - 9.81 * 0.5 * 0.5 / 2);
  const bool sound = std::abs(hangs - 2) < 1e-12 && std::abs(falls - 0.774) < 0.01 &&
                     std::abs(lies - 0.5) < 0.001 && std::abs(turns - 2) < 1e-12 && swings < 1.9;
  return sound ? 0 : 1;
}
