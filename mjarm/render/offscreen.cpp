#include "mjarm/render/offscreen.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <utility>

#include "mjarm/core/messages/render.hpp"
#include "mjarm/model/mujoco_guard.hpp"

namespace mjarm::render {
namespace {

constexpr int kMaxSize = 8192;

/// OpenGL gives rows from bottom to top.
/// @param row  numbers in a row
template <class T>
void flip_rows(std::vector<T>& picture, int row) {
  auto top = picture.begin();
  auto bottom = picture.end() - row;
  for (; top < bottom; top += row, bottom -= row) std::swap_ranges(top, top + row, bottom);
}

/// Moves the plane in front of which nothing is drawn; the lines of sight stay.
void set_nearest(mjvGLCamera& camera, float nearest) {
  const float scale = nearest / camera.frustum_near;
  camera.frustum_near = nearest;
  camera.frustum_center *= scale;
  camera.frustum_width *= scale;
  camera.frustum_bottom *= scale;
  camera.frustum_top *= scale;
}

/// From what OpenGL holds (1 at the near plane, 0 at the far one) to [m]; 0 at the far plane.
void to_metres(std::vector<float>& depth, double near, double far) {
  for (float& value : depth) {
    const double d = value;
    value = d > 0 ? static_cast<float>(near * far / (near + d * (far - near))) : 0;
  }
}

/// Each pixel the mean of 2 x 2.
Image halved(const Image& image) {
  Image out{image.width / 2, image.height / 2, {}};
  out.rgb.reserve(image.rgb.size() / 4);
  const std::size_t row = 3 * static_cast<std::size_t>(image.width);
  for (int y = 0; y < out.height; ++y) {
    const std::uint8_t* above = image.rgb.data() + 2 * row * static_cast<std::size_t>(y);
    for (std::size_t i = 0; i < 3 * static_cast<std::size_t>(out.width); ++i) {
      const std::uint8_t* four = above + 6 * (i / 3) + i % 3;
      const int sum = four[0] + four[3] + four[row] + four[row + 3];
      out.rgb.push_back(static_cast<std::uint8_t>((sum + 2) / 4));
    }
  }
  return out;
}

/// As asked for, where so many pixels can be drawn.
int supersampling_of(const OffscreenOptions& options) {
  const bool fits = 2 * std::max(options.width, options.height) <= kMaxSize;
  return options.supersampling > 1 && fits ? 2 : 1;
}

}  // namespace

struct OffscreenRenderer::Impl {
  Impl(GlContext context, const Model& model, const OffscreenOptions& options)
      : gl(std::move(context)),
        quality(gl.is_software() ? options.software_quality.value_or(options.quality)
                                 : options.quality),
        scene(model, quality, gl.is_software()),
        supersampling(supersampling_of(options)),
        viewport{0, 0, supersampling * options.width, supersampling * options.height} {
    mjr_defaultContext(&context_);
    if (!options.sites) std::fill_n(scene.option().sitegroup, mjNGROUP, mjtByte{0});
  }
  ~Impl() {
    if (gl.make_current()) mjr_freeContext(&context_);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  /// Uploads the model; the context must be current, and is not any more afterwards.
  Result<void> upload() {
    mjModel m = scene.model();
    m.vis.global.offwidth = viewport.width;
    m.vis.global.offheight = viewport.height;
    m.vis.quality.offsamples /= supersampling * supersampling;
    const int font = supersampling > 1 ? mjFONTSCALE_300 : mjFONTSCALE_150;
    const MujocoOutcome outcome = call_mujoco([&] { mjr_makeContext(&m, &context_, font); });
    gl.release();
    if (outcome.failed) {
      return fail(Errc::not_available, text(msg::render_upload_failed, outcome.error));
    }
    return {};
  }

  /// Makes the list of what is seen; the context is current afterwards.
  Result<void> prepare(const Snapshot& snapshot, const Camera& camera, const Overlay& overlay) {
    if (Result<void> set = scene.set_state(snapshot); !set) return set;
    if (Result<void> set = scene.set_camera(camera); !set) return set;
    if (Result<void> current = gl.make_current(); !current) return current;
    scene.update(overlay);
    return {};
  }

  /// Draws what `prepare` has listed, and reads colours and depth where they are wanted.
  Result<void> render(std::uint8_t* rgb, float* depth) {
    mjr_setBuffer(mjFB_OFFSCREEN, &context_);
    mjr_render(viewport, &scene.raw(), &context_);
    mjr_readPixels(rgb, depth, viewport, &context_);
    const int error = mjr_getError();
    gl.release();
    if (error != 0) return fail(Errc::system, text(msg::render_gl_error, error));
    return {};
  }

  GlContext gl;  ///< must outlive `context_`
  RenderQuality quality;
  Scene scene;
  int supersampling;
  mjrRect viewport;
  mjrContext context_{};
};

Result<OffscreenRenderer> OffscreenRenderer::create(const Model& model,
                                                    const OffscreenOptions& options) {
  const auto fits = [](int size) { return size >= 1 && size <= kMaxSize; };
  if (!fits(options.width) || !fits(options.height)) {
    return fail(Errc::bad_input,
                text(msg::render_bad_size, options.width, options.height, kMaxSize));
  }
  Result<GlContext> gl = GlContext::create(options.gl);
  if (!gl) return fail(std::move(gl.error()));
  auto impl = std::make_unique<Impl>(std::move(*gl), model, options);
  if (Result<void> uploaded = impl->upload(); !uploaded) return fail(std::move(uploaded.error()));
  return OffscreenRenderer(std::move(impl));
}

OffscreenRenderer::OffscreenRenderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
OffscreenRenderer::~OffscreenRenderer() = default;
OffscreenRenderer::OffscreenRenderer(OffscreenRenderer&&) noexcept = default;
OffscreenRenderer& OffscreenRenderer::operator=(OffscreenRenderer&&) noexcept = default;

Result<Image> OffscreenRenderer::draw(const Snapshot& snapshot, const Camera& camera,
                                      const Overlay& overlay) {
  if (Result<void> ready = impl_->prepare(snapshot, camera, overlay); !ready) {
    return fail(std::move(ready.error()));
  }
  mjvScene& scene = impl_->scene.raw();
  // Lines have their width in pixels.
  for (int i = 0; i < scene.ngeom; ++i) {
    mjvGeom& geom = scene.geoms[i];
    if (geom.type == mjGEOM_LINE) geom.size[0] *= static_cast<float>(impl_->supersampling);
  }
  impl_->context_.shadowClip = static_cast<float>(impl_->scene.shadow_reach());
  Image image{impl_->viewport.width, impl_->viewport.height, {}};
  image.rgb.resize(3 * static_cast<std::size_t>(image.width) * image.height);
  if (Result<void> drawn = impl_->render(image.rgb.data(), nullptr); !drawn) {
    return fail(std::move(drawn.error()));
  }
  flip_rows(image.rgb, 3 * image.width);
  return impl_->supersampling > 1 ? halved(image) : image;
}

Result<std::vector<float>> OffscreenRenderer::draw_depth(const Snapshot& snapshot,
                                                         const Camera& camera, double nearest) {
  if (impl_->quality != RenderQuality::exact || impl_->supersampling > 1) {
    return fail(Errc::usage, text(msg::render_depth_not_exact));
  }
  if (Result<void> ready = impl_->prepare(snapshot, camera, {}); !ready) {
    return fail(std::move(ready.error()));
  }
  mjvScene& scene = impl_->scene.raw();
  for (mjvGLCamera& eye : scene.camera) set_nearest(eye, static_cast<float>(nearest));
  // Numbers near 0 are the finest, so they are given to what is far away.
  impl_->context_.readDepthMap = mjDEPTH_ZEROFAR;
  std::vector<float> depth(static_cast<std::size_t>(impl_->viewport.width) *
                           static_cast<std::size_t>(impl_->viewport.height));
  if (Result<void> drawn = impl_->render(nullptr, depth.data()); !drawn) {
    return fail(std::move(drawn.error()));
  }
  flip_rows(depth, impl_->viewport.width);
  to_metres(depth, scene.camera[0].frustum_near, scene.camera[0].frustum_far);
  return depth;
}

Scene& OffscreenRenderer::scene() noexcept { return impl_->scene; }
const GlContext& OffscreenRenderer::gl() const noexcept { return impl_->gl; }
RenderQuality OffscreenRenderer::quality() const noexcept { return impl_->quality; }

}  // namespace mjarm::render
