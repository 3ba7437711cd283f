#include "mjarm/render/camera.hpp"

#include <mujoco/mujoco.h>

#include <cmath>
#include <string_view>

#include "mjarm/core/messages/render.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/render/clear_view.hpp"

namespace mjarm::render {
namespace {

Result<void> check_number(const char* name, double value, bool positive) {
  if (std::isfinite(value) && (!positive || value > 0)) return {};
  const std::string expected =
      text(positive ? msg::render_a_positive_number : msg::render_a_finite_number);
  return fail(Errc::bad_input, text(msg::render_bad_view, name, value, expected));
}

Result<void> check_view(const CameraView& view) {
  for (const auto& [name, value] :
       {std::pair("lookat x", view.lookat_W.x()), std::pair("lookat y", view.lookat_W.y()),
        std::pair("lookat z", view.lookat_W.z()), std::pair("azimuth", view.azimuth),
        std::pair("elevation", view.elevation)}) {
    if (Result<void> checked = check_number(name, value, false); !checked) return checked;
  }
  return check_number("distance", view.distance, true);
}

}  // namespace

CameraView default_view(const Model& model) {
  constexpr double kRoom = 1.2;  // round what moves, for its way
  constexpr double kTiny = 0.4;  // of the model's own distance
  constexpr double kFar = 0.4;   // likewise; off what the model's own view looks at
  mjvCamera camera;
  mjv_defaultFreeCamera(model.raw(), &camera);
  const CameraView own{.lookat_W = Eigen::Map<const Eigen::Vector3d>(camera.lookat),
                       .distance = camera.distance,
                       .azimuth = camera.azimuth * kRadPerDeg,
                       .elevation = camera.elevation * kRadPerDeg};
  const Snapshot home;
  const std::vector<FramedBall> balls = moving_parts(model, {&home, 1});
  if (balls.empty()) return own;
  Eigen::Vector3d low = balls.front().p_W, high = low;
  for (const FramedBall& ball : balls) {
    low = low.cwiseMin(ball.p_W);
    high = high.cwiseMax(ball.p_W);
  }
  // A ball, since it will not stay as it is: what is flat from there now need not be later.
  const FramedBall round{0.5 * (low + high), 0.5 * kRoom * (high - low).norm()};
  const CameraView near =
      framing_view(model, {&round, 1}, {.azimuth = own.azimuth, .elevation = own.elevation});
  const bool tiny = near.distance < kTiny * own.distance;
  const bool aside = (round.p_W - own.lookat_W).norm() > kFar * own.distance;
  return tiny || aside ? near : own;
}

std::vector<std::string> camera_names(const Model& model) {
  std::vector<std::string> names;
  for (int id = 0; id < model.raw()->ncam; ++id) {
    const char* name = mj_id2name(model.raw(), mjOBJ_CAMERA, id);
    if (name != nullptr && *name != '\0') names.emplace_back(name);
  }
  return names;
}

Result<void> check_camera(const Model& model, const Camera& camera) {
  if (camera.view) return check_view(*camera.view);
  if (camera.name.empty()) return {};
  if (mj_name2id(model.raw(), mjOBJ_CAMERA, camera.name.c_str()) >= 0) return {};
  const std::vector<std::string> names = camera_names(model);
  const std::string list = names.empty() ? text(msg::render_none) : listed(names);
  return fail(Errc::bad_input, text(msg::render_no_camera, model.file().string(), camera.name,
                                    did_you_mean(camera.name, names), list));
}

}  // namespace mjarm::render
