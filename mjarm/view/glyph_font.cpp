#include <GL/gl.h>
// After gl.h.
#include <GL/glext.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "mjarm/render/glyph.hpp"
#include "mjarm/view/glyph_font_internal.hpp"

namespace mjarm::view {
namespace {

constexpr double kSizeOfLine = 0.88;  ///< size of the font by height of a line
constexpr int kTextureSide = 1024;    ///< [pixels] room for 1000 letters of a plain screen

}  // namespace

bool is_ascii(std::string_view text) noexcept {
  return std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

/// The functions of OpenGL that are needed, found at run time like all of OpenGL.
struct GlyphFont::Gl {
  unsigned texture = 0;
  decltype(&glGenTextures) gen_textures = nullptr;
  PFNGLACTIVETEXTUREPROC active_texture = nullptr;
  decltype(&glBindTexture) bind_texture = nullptr;
  decltype(&glTexParameteri) tex_parameter = nullptr;
  decltype(&glTexImage2D) tex_image = nullptr;
  decltype(&glTexSubImage2D) tex_sub_image = nullptr;
  decltype(&glTexEnvi) tex_env = nullptr;
  decltype(&glPixelStorei) pixel_store = nullptr;
  decltype(&glPushAttrib) push_attrib = nullptr;
  decltype(&glPopAttrib) pop_attrib = nullptr;
  decltype(&glEnable) enable = nullptr;
  decltype(&glDisable) disable = nullptr;
  decltype(&glBlendFunc) blend_func = nullptr;
  decltype(&glMatrixMode) matrix_mode = nullptr;
  decltype(&glLoadIdentity) load_identity = nullptr;
  decltype(&glOrtho) ortho = nullptr;
  decltype(&glViewport) viewport = nullptr;
  decltype(&glScissor) scissor = nullptr;
  decltype(&glColor3fv) color = nullptr;
  decltype(&glBegin) begin = nullptr;
  decltype(&glEnd) end = nullptr;
  decltype(&glTexCoord2f) tex_coord = nullptr;
  decltype(&glVertex2i) vertex = nullptr;

  bool load(FindFunction get) {
    bool all = true;
    const auto find = [&](auto& target, const char* name) {
      target = reinterpret_cast<std::decay_t<decltype(target)>>(get(name));
      all = all && target != nullptr;
    };
    find(gen_textures, "glGenTextures");
    find(active_texture, "glActiveTexture");
    find(bind_texture, "glBindTexture");
    find(tex_parameter, "glTexParameteri");
    find(tex_image, "glTexImage2D");
    find(tex_sub_image, "glTexSubImage2D");
    find(tex_env, "glTexEnvi");
    find(pixel_store, "glPixelStorei");
    find(push_attrib, "glPushAttrib");
    find(pop_attrib, "glPopAttrib");
    find(enable, "glEnable");
    find(disable, "glDisable");
    find(blend_func, "glBlendFunc");
    find(matrix_mode, "glMatrixMode");
    find(load_identity, "glLoadIdentity");
    find(ortho, "glOrtho");
    find(viewport, "glViewport");
    find(scissor, "glScissor");
    find(color, "glColor3fv");
    find(begin, "glBegin");
    find(end, "glEnd");
    find(tex_coord, "glTexCoord2f");
    find(vertex, "glVertex2i");
    return all;
  }
  void make_texture(int side) {
    active_texture(GL_TEXTURE0);  // MuJoCo may have left another one in use
    gen_textures(1, &texture);
    bind_texture(GL_TEXTURE_2D, texture);
    tex_parameter(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    tex_parameter(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    tex_image(GL_TEXTURE_2D, 0, GL_ALPHA, side, side, 0, GL_ALPHA, GL_UNSIGNED_BYTE, nullptr);
  }
  /// For texts in pixels of the window; `pop_attrib` ends it.
  void set_state(const PixelBox& window, const PixelBox& box, const float rgb[3]) const {
    push_attrib(GL_ALL_ATTRIB_BITS);
    active_texture(GL_TEXTURE1);  // of shadows
    disable(GL_TEXTURE_2D);
    active_texture(GL_TEXTURE0);
    for (const unsigned what : {GL_DEPTH_TEST, GL_CULL_FACE, GL_LIGHTING, GL_COLOR_MATERIAL,
                                GL_TEXTURE_GEN_S, GL_TEXTURE_GEN_T, GL_TEXTURE_CUBE_MAP, GL_FOG}) {
      disable(what);
    }
    viewport(0, 0, window.width, window.height);
    matrix_mode(GL_TEXTURE);
    load_identity();
    matrix_mode(GL_PROJECTION);
    load_identity();
    ortho(0, window.width, 0, window.height, -1, 1);
    matrix_mode(GL_MODELVIEW);
    load_identity();
    enable(GL_SCISSOR_TEST);
    scissor(box.left, box.bottom, std::max(box.width, 0), std::max(box.height, 0));
    enable(GL_BLEND);
    blend_func(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    enable(GL_TEXTURE_2D);
    bind_texture(GL_TEXTURE_2D, texture);
    tex_env(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_MODULATE);
    color(rgb);
  }
};

GlyphFont::GlyphFont(int line_height, FindFunction find)
    : size_(std::max(static_cast<int>(std::lround(kSizeOfLine * line_height)), 6)),
      cell_(2 * size_ + 2),
      columns_(std::max(kTextureSide / cell_, 16)),
      gl_(std::make_unique<Gl>()) {
  if (gl_->load(find)) {
    gl_->push_attrib(GL_TEXTURE_BIT);
    gl_->make_texture(columns_ * cell_);
    gl_->pop_attrib();
  }
}
GlyphFont::~GlyphFont() = default;  // the texture goes with the window

const GlyphFont::Letter& GlyphFont::letter(const std::string& utf8, bool to_texture) {
  Letter& letter = letters_[utf8];
  if (letter.cell >= 0 || (letter.advance > 0 && !to_texture)) return letter;
  const render::Glyph glyph = render::draw_glyph(utf8, size_);
  letter = {-1, std::min(glyph.width, cell_), glyph.left, glyph.advance};
  if (!to_texture || glyph.ink.empty()) return letter;
  letter.cell = used_++;
  gl_->pixel_store(GL_UNPACK_ALIGNMENT, 1);
  gl_->tex_sub_image(GL_TEXTURE_2D, 0, letter.cell % columns_ * cell_,
                     letter.cell / columns_ * cell_, letter.width, glyph.height, GL_ALPHA,
                     GL_UNSIGNED_BYTE, glyph.ink.data());
  gl_->pixel_store(GL_UNPACK_ALIGNMENT, 4);
  return letter;
}

int GlyphFont::width(std::string_view text) {
  int width = 0;
  for (const std::string& utf8 : render::letters_of(text)) width += letter(utf8, false).advance;
  return width;
}

void GlyphFont::draw(std::string_view text, const PixelBox& window, const PixelBox& box,
                     const float rgb[3], int max_width) {
  if (gl_->texture == 0) return;
  const std::vector<std::string> letters = render::letters_of(text);
  // A full texture begins anew.
  if (used_ + static_cast<int>(letters.size()) > columns_ * columns_) {
    letters_.clear();
    used_ = 0;
  }
  gl_->set_state(window, box, rgb);
  const float side = static_cast<float>(columns_ * cell_);
  const int base = box.bottom + size_ / 5;  // room below the line for g, p and the like
  int pen = 0;
  for (const std::string& utf8 : letters) {
    const Letter& drawn = letter(utf8, true);
    if (pen + drawn.advance > max_width) break;
    const int left = drawn.cell % columns_ * cell_;
    const int bottom = drawn.cell / columns_ * cell_;
    gl_->begin(GL_QUADS);
    for (const auto& [right, up] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
      const int dx = right * drawn.width;
      const int dy = up * cell_;
      gl_->tex_coord(static_cast<float>(left + dx) / side, static_cast<float>(bottom + dy) / side);
      gl_->vertex(box.left + pen + drawn.left + dx, base - cell_ / 4 + dy);
    }
    gl_->end();
    pen += drawn.advance;
  }
  gl_->pop_attrib();
}

}  // namespace mjarm::view
