#include <cstdio>
#include <system_error>

#include "mjarm/core/messages/view.hpp"
#include "mjarm/render/png.hpp"
#include "mjarm/view/screenshot_internal.hpp"

namespace mjarm::view {

Result<std::filesystem::path> save_screenshot(const render::Image& image,
                                              const std::filesystem::path& folder) {
  constexpr int kMax = 9999;
  std::error_code ignored;  // a folder that cannot be made shows when the file is written
  std::filesystem::create_directories(folder, ignored);
  for (int i = 1; i <= kMax; ++i) {
    char name[32];
    std::snprintf(name, sizeof(name), "mjarm-%03d.png", i);
    const std::filesystem::path file = folder / name;
    if (std::filesystem::exists(file, ignored)) continue;
    if (auto written = render::write_png(image, file); !written)
      return fail(std::move(written.error()));
    return file;
  }
  return fail(Errc::system, text(msg::view_many_screenshots, folder.string(), kMax));
}

}  // namespace mjarm::view
