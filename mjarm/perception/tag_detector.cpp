#include "mjarm/perception/tag_detector.hpp"

#ifdef MJARM_APRILTAG
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#endif

#include <algorithm>
#include <tuple>
#include <utility>

#include "mjarm/core/messages/perception.hpp"

namespace mjarm::perception {

#ifdef MJARM_APRILTAG
namespace {

struct DeleteFamily {
  void operator()(apriltag_family_t* family) const { tag36h11_destroy(family); }
};
struct DeleteDetector {
  void operator()(apriltag_detector_t* detector) const { apriltag_detector_destroy(detector); }
};
using Family = std::unique_ptr<apriltag_family_t, DeleteFamily>;

/// Brightness, as the library wants it.
std::vector<std::uint8_t> gray_of(const render::Image& image) {
  std::vector<std::uint8_t> gray(image.rgb.size() / 3);
  for (std::size_t i = 0; i < gray.size(); ++i) {
    const std::uint8_t* rgb = image.rgb.data() + 3 * i;
    gray[i] = static_cast<std::uint8_t>((2 * rgb[0] + 5 * rgb[1] + rgb[2]) / 8);
  }
  return gray;
}

SeenTag seen_tag(const apriltag_detection_t& detection) {
  SeenTag out{.id = detection.id};
  // The library counts from the corner of a pixel, we from its middle.
  for (std::size_t i = 0; i < 4; ++i) {
    out.corners[i] = Eigen::Vector2d(detection.p[i][0], detection.p[i][1]).array() - 0.5;
  }
  return out;
}

/// False where a corner may be cut off: where two edges of the tag end at the picture's, the
/// detector still tells a corner.
bool is_inside(const SeenTag& tag, const render::Image& image) {
  constexpr double kRim = 4;  // [px]
  return std::all_of(tag.corners.begin(), tag.corners.end(), [&](const Eigen::Vector2d& corner) {
    return corner.minCoeff() >= kRim && corner.x() <= image.width - 1 - kRim &&
           corner.y() <= image.height - 1 - kRim;
  });
}

/// A white rim, a black square, and the bits in it, the first one the most significant.
std::vector<std::uint8_t> cells_of(const apriltag_family_t& family, int id) {
  const int width = family.total_width;
  const int rim = (width - family.width_at_border) / 2;
  std::vector<std::uint8_t> cells(static_cast<std::size_t>(width * width), 255);
  const auto cell = [&](int x, int y) -> std::uint8_t& {
    return cells[static_cast<std::size_t>((y + rim) * width + x + rim)];
  };
  for (int y = 0; y < family.width_at_border; ++y) {
    for (int x = 0; x < family.width_at_border; ++x) cell(x, y) = 0;
  }
  for (std::uint32_t i = 0; i < family.nbits; ++i) {
    const bool white = (family.codes[id] >> (family.nbits - 1 - i) & 1) != 0;
    if (white) cell(static_cast<int>(family.bit_x[i]), static_cast<int>(family.bit_y[i])) = 255;
  }
  return cells;
}

}  // namespace

struct TagDetector::Impl {
  Impl() {
    detector->nthreads = 1;
    detector->quad_decimate = 2;  // edges are looked at in the whole picture all the same
    apriltag_detector_add_family_bits(detector.get(), family.get(), 1);
  }
  Family family{tag36h11_create()};
  std::unique_ptr<apriltag_detector_t, DeleteDetector> detector{apriltag_detector_create()};
};

Result<TagDetector> TagDetector::create() { return TagDetector(std::make_unique<Impl>()); }

std::vector<SeenTag> TagDetector::find(const render::Image& image) {
  std::vector<std::uint8_t> gray = gray_of(image);
  image_u8_t picture{image.width, image.height, image.width, gray.data()};
  zarray_t* found = apriltag_detector_detect(impl_->detector.get(), &picture);
  std::vector<SeenTag> out;
  for (int i = 0; i < zarray_size(found); ++i) {
    apriltag_detection_t* detection = nullptr;
    zarray_get(found, i, &detection);
    const SeenTag tag = seen_tag(*detection);
    if (is_inside(tag, image)) out.push_back(tag);
  }
  apriltag_detections_destroy(found);
  std::sort(out.begin(), out.end(), [](const SeenTag& a, const SeenTag& b) {
    return std::tuple(a.id, a.corners[0].x()) < std::tuple(b.id, b.corners[0].x());
  });
  return out;
}

Result<render::Image> tag_picture(int id, int pixels) {
  constexpr int kMaxPixels = 100;
  if (id < 0 || id >= kTagCount || pixels < 1 || pixels > kMaxPixels) {
    return fail(Errc::bad_input,
                text(msg::perception_bad_tag, id, kTagCount - 1, pixels, kMaxPixels));
  }
  const Family family(tag36h11_create());
  const std::vector<std::uint8_t> cells = cells_of(*family, id);
  const int side = family->total_width * pixels;
  render::Image out{side, side, {}};
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      out.rgb.insert(
          out.rgb.end(), 3,
          cells[static_cast<std::size_t>(y / pixels * family->total_width + x / pixels)]);
    }
  }
  return out;
}

bool has_tags() noexcept { return true; }

#else
struct TagDetector::Impl {};

Result<TagDetector> TagDetector::create() {
  return fail(Errc::not_available, text(msg::perception_no_apriltag));
}
std::vector<SeenTag> TagDetector::find(const render::Image&) { return {}; }

Result<render::Image> tag_picture(int, int) {
  return fail(Errc::not_available, text(msg::perception_no_apriltag));
}

bool has_tags() noexcept { return false; }
#endif

TagDetector::TagDetector(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
TagDetector::~TagDetector() = default;
TagDetector::TagDetector(TagDetector&&) noexcept = default;
TagDetector& TagDetector::operator=(TagDetector&&) noexcept = default;

}  // namespace mjarm::perception
