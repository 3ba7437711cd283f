#include <algorithm>

#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/core/messages/check.hpp"
#include "mjarm/core/messages/model.hpp"
#include "mjarm/model/check_internal.hpp"

namespace mjarm {
namespace {

/// Rounding of the figures in files, relative to the largest moment.
constexpr double kMomentSlack = 1e-6;

/// Moments as an MJCF <inertial> gives them; none where it gives none or they cannot be read.
std::optional<Eigen::Vector3d> moments_of_mjcf(const SourceNode& inertial) {
  const std::vector<double> diagonal = numbers_in(inertial.attribute("diaginertia"));
  if (diagonal.size() == 3) return Eigen::Vector3d(diagonal[0], diagonal[1], diagonal[2]);
  const std::vector<double> full = numbers_in(inertial.attribute("fullinertia"));
  if (full.size() != 6) return std::nullopt;
  Eigen::Matrix3d I;
  I << full[0], full[3], full[4], full[3], full[1], full[5], full[4], full[5], full[2];
  return principal_moments(I);
}

void check_mjcf_inertial(const CheckContext& context, const SourceNode& inertial) {
  const bool moves = context.description.has_joint(inertial.body);
  Place place = context.description.place(inertial);
  place.element = text(msg::model_element_of, "inertial", inertial.body);
  const std::vector<double> mass = numbers_in(inertial.attribute("mass"));
  if (moves && mass.size() == 1 && !(mass[0] > 0)) {
    context.add(CheckCode::mass_zero, Grade::error, place, text(msg::check_mass_zero, mass[0]));
  }
  if (const auto moments = moments_of_mjcf(inertial); moments && moves) {
    check_moments(context, place, *moments);
  }
}

/// A body that a joint moves needs mass: its own, of its geoms, or of bodies fixed to it.
void check_mjcf_body(const CheckContext& context, const SourceNode& body) {
  const bool moves = context.description.has_joint(std::string(body.attribute("name")));
  if (!moves || context.model != nullptr) return;  // MuJoCo loads no such body
  for (const char* child : {"inertial", "geom", "body", "frame", "include", "composite"}) {
    if (body.element->FirstChildElement(child) != nullptr) return;
  }
  context.add(CheckCode::inertial_missing, Grade::error, context.description.place(body),
              text(msg::check_inertial_missing));
}

}  // namespace

Eigen::Vector3d principal_moments(const Eigen::Matrix3d& I) { return symmetric_eigen(I).values; }

void check_moments(const CheckContext& context, const Place& place,
                   const Eigen::Vector3d& principal) {
  Eigen::Vector3d I = principal;
  std::sort(I.begin(), I.end());
  if (!(I[0] > 0)) {
    context.add(CheckCode::inertia_not_positive, Grade::error, place,
                text(msg::check_inertia_not_positive, I[0], I[1], I[2]));
  } else if (I[0] + I[1] < I[2] * (1 - kMomentSlack)) {
    context.add(CheckCode::inertia_triangle, Grade::error, place,
                text(msg::check_inertia_triangle, I[0], I[1], I[2]));
  }
}

void check_inertials(const CheckContext& context) {
  for (const SourceNode& node : context.description.nodes()) {
    if (node.section != "worldbody") continue;
    if (node.kind() == "inertial") check_mjcf_inertial(context, node);
    if (node.kind() == "body") check_mjcf_body(context, node);
  }
}

}  // namespace mjarm
