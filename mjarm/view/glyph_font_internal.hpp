#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace mjarm::view {

/// MuJoCo's own font is ASCII: what it lacks is drawn with this one.
[[nodiscard]] bool is_ascii(std::string_view text) noexcept;

/// A part of a window [pixels], from its lower left.
struct PixelBox {
  int left = 0;
  int bottom = 0;
  int width = 0;
  int height = 0;
};

/// A font for any text, its letters drawn into a texture when they are needed first. An OpenGL
/// context is current in every call, but the destructor.
class GlyphFont {
 public:
  /// Address of an OpenGL function, or null.
  using FindFunction = void (*(*)(const char* name))();

  /// @param line_height  [pixels] of the lines that texts stand in.
  GlyphFont(int line_height, FindFunction find);
  ~GlyphFont();
  GlyphFont(const GlyphFont&) = delete;
  GlyphFont& operator=(const GlyphFont&) = delete;

  /// [pixels]
  [[nodiscard]] int width(std::string_view text);
  /// Draws a text into a window of that size [pixels].
  /// @param box      where it begins, at the lower left; what leaves the box is not drawn.
  /// @param max_width  letters that end beyond it are left out, from the first one on.
  void draw(std::string_view text, const PixelBox& window, const PixelBox& box, const float rgb[3],
            int max_width);

 private:
  struct Letter {
    int cell = -1;  ///< of the texture; -1 = not there
    int width = 0;
    int left = 0;
    int advance = 0;
  };
  struct Gl;
  /// Its measures; drawn into the texture too where `to_texture`.
  const Letter& letter(const std::string& utf8, bool to_texture);

  int size_;     ///< [pixels] of the font
  int cell_;     ///< [pixels] side of a cell of the texture
  int columns_;  ///< cells in a row of the texture, and rows
  int used_ = 0;
  std::map<std::string, Letter, std::less<>> letters_;
  std::unique_ptr<Gl> gl_;
};

}  // namespace mjarm::view
