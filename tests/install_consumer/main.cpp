// A project of somebody else, built against the installed mjarm.
#include <cstdio>

#include "mjarm/core/pose.hpp"

int main() {
  const mjarm::Pose X_WT{};
  std::printf("%g %g %g\n", X_WT.p.x(), X_WT.p.y(), X_WT.p.z());
}
