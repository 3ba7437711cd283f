// README's lines for C++, word for word, in a project of somebody else; and a shipped program.
#include <cstdio>

#include "mjarm/core/rotation.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/program/load_program.hpp"
#include "mjarm/trajectory/tool_motion.hpp"

int main() {
#include "snippet.inc"
  if (!robot) return std::fprintf(stderr, "%s\n", robot.error().what.c_str()), 1;
  if (!motion) return std::fprintf(stderr, "no motion\n"), 1;
  const auto program = mjarm::program::find_shipped_program("ellipse");
  if (!program) return std::fprintf(stderr, "%s\n", program.error().what.c_str()), 1;
  std::printf("%d joints\n", robot->arm.dof());
}
