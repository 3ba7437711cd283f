#include <cmath>

#include "mjarm/core/rotation.hpp"
#include "mjarm/serve/json_parts_internal.hpp"

namespace mjarm::serve {

double shortened(double value) {
  if (value == 0 || !std::isfinite(value)) return 0;
  const double scale = std::pow(10.0, 5 - std::floor(std::log10(std::abs(value))));
  return std::isfinite(scale) ? std::round(value * scale) / scale : 0;
}

void add_color(JsonWriter& json, const render::Rgba& color) {
  json.key("rgba").list();
  for (const float part : {color.r, color.g, color.b, color.a}) {
    json.value(std::isfinite(part) ? std::round(1e3 * part) / 1e3 : 1.0);
  }
  json.end_list();
}

void add_point(JsonWriter& json, const Eigen::Vector3d& p) {
  json.list().value(shortened(p.x())).value(shortened(p.y())).value(shortened(p.z())).end_list();
}

void add_place(JsonWriter& json, const Pose& X) {
  const Quat q = to_quat(X.R);
  add_point(json.key("pos"), X.p);
  json.key("quat").list();
  for (const double part : {q.w(), q.x(), q.y(), q.z()}) json.value(shortened(part));
  json.end_list();
}

void add_seven(JsonWriter& json, const Pose& X) {
  const Quat q = to_quat(X.R);
  for (const double part : {X.p.x(), X.p.y(), X.p.z(), q.w(), q.x(), q.y(), q.z()}) {
    json.value(shortened(part));
  }
}

}  // namespace mjarm::serve
