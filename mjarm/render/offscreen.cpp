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
void flip_rows(Image& image) {
  const std::size_t row = 3 * static_cast<std::size_t>(image.width);
  auto top = image.rgb.begin();
  auto bottom = image.rgb.end() - static_cast<std::ptrdiff_t>(row);
  for (; top < bottom; top += row, bottom -= row) {
    std::swap_ranges(top, top + static_cast<std::ptrdiff_t>(row), bottom);
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
  Scene& scene = impl_->scene;
  if (Result<void> set = scene.set_state(snapshot); !set) return fail(std::move(set.error()));
  if (Result<void> set = scene.set_camera(camera); !set) return fail(std::move(set.error()));
  if (Result<void> current = impl_->gl.make_current(); !current) {
    return fail(std::move(current.error()));
  }
  scene.update(overlay);
  // Lines have their width in pixels.
  for (int i = 0; i < scene.raw().ngeom; ++i) {
    mjvGeom& geom = scene.raw().geoms[i];
    if (geom.type == mjGEOM_LINE) geom.size[0] *= static_cast<float>(impl_->supersampling);
  }
  impl_->context_.shadowClip = static_cast<float>(scene.shadow_reach());
  mjr_setBuffer(mjFB_OFFSCREEN, &impl_->context_);
  mjr_render(impl_->viewport, &scene.raw(), &impl_->context_);
  Image image{impl_->viewport.width, impl_->viewport.height, {}};
  image.rgb.resize(3 * static_cast<std::size_t>(image.width) * image.height);
  mjr_readPixels(image.rgb.data(), nullptr, impl_->viewport, &impl_->context_);
  const int error = mjr_getError();
  impl_->gl.release();
  if (error != 0) {
    return fail(Errc::system, text(msg::render_gl_error, error));
  }
  flip_rows(image);
  return impl_->supersampling > 1 ? halved(image) : image;
}

const GlContext& OffscreenRenderer::gl() const noexcept { return impl_->gl; }
RenderQuality OffscreenRenderer::quality() const noexcept { return impl_->quality; }

}  // namespace mjarm::render
