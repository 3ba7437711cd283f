// A project of somebody else, built against the installed mjarm: where is the tool of the UR5e?
#include <cstdio>

#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/model.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto model = mjarm::find_model_file(argv[1]).and_then(
      [](const auto& file) { return mjarm::Model::load(file); });
  if (!model) return std::fprintf(stderr, "%s\n", model.error().what.c_str()), 1;
  const auto arm = mjarm::find_arm(*model);
  if (!arm) return std::fprintf(stderr, "%s\n", arm.error().what.c_str()), 1;
  const mjarm::Pose X_WT = mjarm::fk(*arm, mjarm::as_span(arm->home));
  std::printf("%.3f %.3f %.3f\n", X_WT.p.x(), X_WT.p.y(), X_WT.p.z());
}
