#include "mjarm/render/rgbd.hpp"

#include <mujoco/mujoco.h>

#include <cmath>
#include <string>
#include <utility>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/render.hpp"
#include "mjarm/render/offscreen.hpp"

namespace mjarm::render {
namespace {

/// As MuJoCo's projection has it: its frustum is told at the near plane, from edge to edge.
CameraIntrinsics intrinsics_of(const mjvGLCamera& eye, int width, int height) {
  const double near = eye.frustum_near;
  const double high = double{eye.frustum_top} - eye.frustum_bottom;
  const double half =
      eye.frustum_width > 0 ? double{eye.frustum_width} : 0.5 * high * width / height;
  return {.width = width,
          .height = height,
          .fx = near * width / (2 * half),
          .fy = near * height / high,
          .cx = width * (half - double{eye.frustum_center}) / (2 * half) - 0.5,
          .cy = height * double{eye.frustum_top} / high - 0.5};
}

/// MuJoCo's cameras look along -z, with y upwards.
Pose pose_of(const mjData& d, int camera) {
  using RowMatrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const Eigen::Map<const RowMatrix> R_WM(d.cam_xmat + 9 * camera);
  return {.p = Eigen::Map<const Eigen::Vector3d>(d.cam_xpos + 3 * camera),
          .R = R_WM * Eigen::Vector3d(1, -1, -1).asDiagonal()};
}

/// Spoils depth as a camera does, and leaves out what is too far for it.
void measure(std::vector<float>& depth, const RgbdOptions& options, Rng& noise) {
  const double growth = options.depth_sigma / (kSigmaDepth * kSigmaDepth);
  for (float& z : depth) {
    if (z > options.farthest) z = 0;
    if (z > 0 && growth > 0) z += static_cast<float>(growth * z * z * noise.normal());
  }
}

Result<void> check_options(const RgbdOptions& options) {
  const auto finite = [](double x) { return std::isfinite(x); };
  if (!(options.depth_sigma >= 0) || !finite(options.depth_sigma)) {
    return fail(Errc::bad_input, text(msg::render_rgbd_range, "depth_sigma", options.depth_sigma,
                                      text(msg::render_rgbd_sigma)));
  }
  if (!(options.nearest > 0) || !(options.farthest > options.nearest) ||
      !finite(options.farthest)) {
    const std::string comma = text(msg::core_comma);
    return fail(Errc::bad_input,
                text(msg::render_rgbd_range, "nearest" + comma + "farthest",
                     std::to_string(options.nearest) + comma + std::to_string(options.farthest),
                     text(msg::render_rgbd_ranges)));
  }
  return {};
}

}  // namespace

struct RgbdCamera::Impl {
  Model model;
  Camera camera;
  int id;
  RgbdOptions options;
  OffscreenRenderer colors;
  OffscreenRenderer depths;
};

Result<RgbdCamera> RgbdCamera::create(const Model& model, std::string_view name,
                                      const RgbdOptions& options) {
  const Camera camera{.name = std::string(name)};
  if (Result<void> checked = check_camera(model, camera); !checked) {
    return fail(std::move(checked.error()));
  }
  if (Result<void> checked = check_options(options); !checked) {
    return fail(std::move(checked.error()));
  }
  const int id = mj_name2id(model.raw(), mjOBJ_CAMERA, camera.name.c_str());
  if (id < 0) return fail(Errc::bad_input, text(msg::render_rgbd_no_name));
  if (model.raw()->cam_projection[id] != mjPROJ_PERSPECTIVE) {
    return fail(Errc::bad_input,
                text(msg::render_rgbd_parallel, model.file().string(), camera.name));
  }
  const OffscreenOptions drawing{.width = options.width,
                                 .height = options.height,
                                 .quality = options.quality,
                                 .gl = options.gl,
                                 .supersampling = options.supersampling,
                                 .sites = false};
  Result<OffscreenRenderer> colors = OffscreenRenderer::create(model, drawing);
  if (!colors) return fail(std::move(colors.error()));
  // Apart from the colours: their pixels are means of samples beside the middle.
  Result<OffscreenRenderer> depths =
      OffscreenRenderer::create(model, {.width = options.width,
                                        .height = options.height,
                                        .quality = RenderQuality::exact,
                                        .gl = options.gl,
                                        .sites = false});
  if (!depths) return fail(std::move(depths.error()));
  return RgbdCamera(std::make_unique<Impl>(
      Impl{model, camera, id, options, std::move(*colors), std::move(*depths)}));
}

RgbdCamera::RgbdCamera(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RgbdCamera::~RgbdCamera() = default;
RgbdCamera::RgbdCamera(RgbdCamera&&) noexcept = default;
RgbdCamera& RgbdCamera::operator=(RgbdCamera&&) noexcept = default;

Result<RgbdFrame> RgbdCamera::look(const Snapshot& snapshot, Rng& noise) {
  Result<Image> color = impl_->colors.draw(snapshot, impl_->camera);
  if (!color) return fail(std::move(color.error()));
  Result<std::vector<float>> depth =
      impl_->depths.draw_depth(snapshot, impl_->camera, impl_->options.nearest);
  if (!depth) return fail(std::move(depth.error()));
  measure(*depth, impl_->options, noise);
  Scene& scene = impl_->depths.scene();
  const mjvGLCamera eye = mjv_averageCamera(&scene.raw().camera[0], &scene.raw().camera[1]);
  return RgbdFrame{.color = std::move(*color),
                   .depth = std::move(*depth),
                   .intrinsics = intrinsics_of(eye, impl_->options.width, impl_->options.height),
                   .X_WC = pose_of(scene.data(), impl_->id)};
}

}  // namespace mjarm::render
