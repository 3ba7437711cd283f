// Fuzzes the loader as users meet it: any bytes give a model or one line of text, and no file.
// An input is a description, or `stl`, `obj`, `msh`, `png` or `bin`, a line break and the content
// of such a file, which a small model then uses. Inputs on which MuJoCo crashed or hung, and the
// guard had to step in, are kept in the folder that MJARM_FUZZ_CAUGHT names.
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "mjarm/core/utf8.hpp"
#include "mjarm/model/model.hpp"
#include "tests/fuzz/finding.hpp"
#include "tests/support/temp_folder.hpp"

namespace {

namespace fs = std::filesystem;
using mjarm::Model;
using mjarm::fuzz::finding;

/// A model that uses the file `ITEM`.
struct User {
  std::string_view kind;
  const char* model;
};
constexpr const char* kMesh =
    "<mujoco><asset><mesh name=\"m\" file=\"ITEM\"/></asset><worldbody><body><joint/><geom "
    "type=\"mesh\" mesh=\"m\"/></body></worldbody></mujoco>";
constexpr std::array<User, 5> kUsers = {
    {{"stl", kMesh},
     {"obj", kMesh},
     {"msh", kMesh},
     {"png",
      "<mujoco><asset><texture name=\"t\" type=\"2d\" file=\"ITEM\"/><hfield name=\"h\" "
      "size=\"1 1 1 1\" file=\"ITEM\"/></asset></mujoco>"},
     {"bin",
      "<mujoco><asset><hfield name=\"h\" size=\"1 1 1 1\" file=\"ITEM\"/></asset></mujoco>"}}};

/// Lays the input down as files; returns the model's.
fs::path lay_down(const mjarm::support::TempFolder& folder, std::string_view input) {
  for (const User& user : kUsers) {
    if (!input.starts_with(user.kind) || input.size() < 4 || input[3] != '\n') continue;
    const std::string item = "item." + std::string(user.kind);
    folder.write(item, input.substr(4));
    std::string model = user.model;
    for (std::size_t at = 0; (at = model.find("ITEM")) != std::string::npos;) {
      model.replace(at, 4, item);
    }
    return folder.write("a.xml", model);
  }
  return folder.write("a.xml", input);
}

void keep(std::string_view input, const std::string& why) {
  const char* folder = std::getenv("MJARM_FUZZ_CAUGHT");
  if (folder == nullptr) return;
  const std::string name = std::to_string(std::hash<std::string_view>()(input));
  std::FILE* file = std::fopen((fs::path(folder) / name).c_str(), "wb");
  if (file == nullptr) return;
  std::fwrite(input.data(), 1, input.size(), file);
  std::fclose(file);
  std::fprintf(stderr, "CAUGHT %s: %s\n", name.c_str(), why.c_str());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const mjarm::support::TempFolder folder;
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  const fs::path file = lay_down(folder, input);
  const auto model = Model::load(file);
  if (!model) {
    const std::string& what = model.error().what;
    if (model.error().code != mjarm::Errc::bad_input) finding("code of the error", what);
    if (what.find('\n') != std::string::npos) finding("more than one line", what);
    if (!mjarm::is_utf8(what)) finding("no UTF-8", what);
    if (what.find(folder.path().string()) == std::string::npos) finding("no file named", what);
    if (what.find("crashed") != std::string::npos ||
        what.find(" needed more") != std::string::npos) {
      keep(input, what);
    }
  } else if (!(model->timestep() > 0)) {
    finding("a time step that is none", std::to_string(model->timestep()));
  }
  for (const auto& entry : fs::directory_iterator(folder.path())) {
    const std::string name = entry.path().filename().string();
    if (name != "a.xml" && !name.starts_with("item.")) finding("a stray file", name);
  }
  return 0;
}
