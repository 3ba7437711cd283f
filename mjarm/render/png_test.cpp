#include "mjarm/render/png.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include "mjarm/core/rng.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::render {
namespace {

Image random_image(int width, int height, std::uint64_t seed) {
  Rng rng(seed);
  Image image{width, height, {}};
  for (int i = 0; i < 3 * width * height; ++i) {
    image.rgb.push_back(static_cast<std::uint8_t>(rng.uniform(0, 256)));
  }
  return image;
}

TEST(Png, ReadsBackAsTheSamePixels) {
  const support::TempFolder folder;
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(37, 21), std::pair(3, 200)}) {
    const Image image = random_image(width, height, 7);
    ASSERT_TRUE(write_png(image, folder.path() / "a.png"));
    const std::string bytes = folder.read("a.png");
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()), 0);
    ASSERT_EQ(static_cast<int>(header.width), width);
    ASSERT_EQ(static_cast<int>(header.height), height);
    header.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(header));
    ASSERT_NE(png_image_finish_read(&header, nullptr, pixels.data(), 0, nullptr), 0);
    EXPECT_EQ(pixels, image.rgb);
  }
}

TEST(Png, EqualPicturesGiveEqualBytes) {
  EXPECT_EQ(encode_png(random_image(64, 48, 3)).value(),
            encode_png(random_image(64, 48, 3)).value());
  EXPECT_NE(encode_png(random_image(64, 48, 3)).value(),
            encode_png(random_image(64, 48, 4)).value());
}

TEST(Png, RefusesPicturesWhoseSizeDoesNotFit) {
  EXPECT_EQ(encode_png({}).error().code, Errc::bad_input);
  EXPECT_EQ(encode_png({2, 2, std::vector<std::uint8_t>(11)}).error().code, Errc::bad_input);
  EXPECT_EQ(encode_png({-1, -1, std::vector<std::uint8_t>(3)}).error().code, Errc::bad_input);
}

TEST(Png, NamesTheFileThatCannotBeWritten) {
  const support::TempFolder folder;
  const Result<void> written =
      write_png(random_image(2, 2, 1), folder.path() / "missing" / "a.png");
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().what.find("missing"), std::string::npos) << written.error().what;
}

}  // namespace
}  // namespace mjarm::render
