#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "mjarm/core/messages/perception.hpp"
#include "mjarm/perception/check_objects_internal.hpp"
#include "mjarm/perception/tag_detector.hpp"

namespace mjarm::perception {
namespace {

/// What is wrong with a surface; empty where nothing is.
std::string fault_of(const Surface& surface) {
  constexpr double kSmallest = 0.005;  // [m]
  constexpr double kLargest = 5;       // [m]
  if (surface.triangles.empty()) return text(msg::perception_no_surface);
  Eigen::Array3d low = Eigen::Array3d::Constant(1e9);
  Eigen::Array3d high = -low;
  for (const Eigen::Vector3d& vertex : surface.vertices) {
    if (!vertex.allFinite()) return text(msg::perception_bad_surface);
    low = low.min(vertex.array());
    high = high.max(vertex.array());
  }
  const int count = static_cast<int>(surface.vertices.size());
  for (const auto& triangle : surface.triangles) {
    for (const int i : triangle) {
      if (i < 0 || i >= count) return text(msg::perception_bad_surface);
    }
  }
  const double across = (high - low).maxCoeff();
  if (across < kSmallest || across > kLargest) return text(msg::perception_size_of_object, across);
  return {};
}

std::string fault_of(const ObjectTag& tag) {
  const bool sound = tag.id >= 0 && tag.id < kTagCount && tag.size > 0 && std::isfinite(tag.size) &&
                     tag.X_OT.p.allFinite() && tag.X_OT.R.allFinite();
  return sound ? std::string() : text(msg::perception_tag_of_object, tag.id, tag.size);
}

/// Whether two bodies that look alike may have these surfaces.
bool is_one_surface(const Surface& a, const Surface& b) {
  constexpr double kSame = 1e-6;  // [m]
  return a.triangles == b.triangles &&
         std::ranges::equal(a.vertices, b.vertices,
                            [](const Eigen::Vector3d& v, const Eigen::Vector3d& w) {
                              return (v - w).cwiseAbs().maxCoeff() < kSame;
                            });
}

/// What is wrong with an object as one of its kind. @param kinds  the first one of each so far.
std::string fault_of_kind(const KnownObject& object,
                          std::map<std::string, const KnownObject*>& kinds) {
  if (object.kind.empty()) return {};
  if (object.tag) return text(msg::perception_kind_with_tag, object.kind);
  const KnownObject& first = *kinds.try_emplace(object.kind, &object).first->second;
  if (is_one_surface(first.surface, object.surface)) return {};
  return text(msg::perception_kind_of_two_shapes, object.kind, first.name);
}

}  // namespace

Result<void> check_objects(std::span<const KnownObject> objects) {
  std::set<std::string> names;
  std::set<int> tags;
  std::map<std::string, const KnownObject*> kinds;
  for (const KnownObject& object : objects) {
    std::string fault = fault_of(object.surface);
    if (fault.empty() && object.tag) fault = fault_of(*object.tag);
    if (fault.empty() && !names.insert(object.name).second)
      fault = text(msg::perception_name_twice);
    if (fault.empty() && object.tag && !tags.insert(object.tag->id).second) {
      fault = text(msg::perception_tag_of_two, object.tag->id);
    }
    if (fault.empty()) fault = fault_of_kind(object, kinds);
    if (!fault.empty()) {
      return fail(Errc::bad_input, text(msg::perception_bad_object, object.name, fault));
    }
  }
  return {};
}

Result<void> check_options(const FindOptions& options) {
  constexpr double kUnit = 1e-6;
  if (!(options.depth_sigma >= 0) || !std::isfinite(options.depth_sigma)) {
    return fail(Errc::bad_input, text(msg::perception_bad_option, "depth_sigma",
                                      options.depth_sigma, text(msg::perception_zero_or_more)));
  }
  if (options.table && (!(std::abs(options.table->normal_W.norm() - 1) < kUnit) ||
                        !std::isfinite(options.table->offset))) {
    return fail(Errc::bad_input, text(msg::perception_bad_option, "table.normal_W",
                                      options.table->normal_W.norm(), text(msg::perception_unit)));
  }
  return {};
}

}  // namespace mjarm::perception
