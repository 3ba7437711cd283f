#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/render/image.hpp"

namespace mjarm::perception {

/// A tag of the family tag36h11 in a picture.
struct SeenTag {
  int id = 0;
  /// [px] corners of the black square: lower left, lower right, upper right, upper left of the tag
  /// as it is printed. Whole numbers are the middles of pixels.
  std::array<Eigen::Vector2d, 4> corners = {};
};

/// Finds tags in pictures (AprilTag 3: M. Krogius, A. Haggenmiller and E. Olson, IROS 2019). Used
/// by one thread at a time; the same picture gives the same answer.
class TagDetector {
 public:
  /// @return not_available, with the package that helps, where the library is not built in.
  [[nodiscard]] static Result<TagDetector> create();
  ~TagDetector();
  TagDetector(TagDetector&&) noexcept;
  TagDetector& operator=(TagDetector&&) noexcept;

  /// All tags that are wholly inside of the picture, by their number, then from left to right.
  [[nodiscard]] std::vector<SeenTag> find(const render::Image& image);

 private:
  struct Impl;
  explicit TagDetector(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Numbers of tags there are: 0 to this, without it.
inline constexpr int kTagCount = 587;

/// The picture of a tag with its white rim, to be printed or put on a geom: 10 x 10 cells, of which
/// the inner 8 x 8 are the black square whose edge is a tag's `size`.
/// @param pixels  [px] across a cell, 1 to 100
/// @return not_available as TagDetector::create; bad_input for a number that no tag has.
[[nodiscard]] Result<render::Image> tag_picture(int id, int pixels);

/// Whether the library is built in.
[[nodiscard]] bool has_tags() noexcept;

}  // namespace mjarm::perception
