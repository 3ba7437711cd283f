// Hostile files: what names files that it should not, or files that are not what they seem.
#include <sys/stat.h>

#include <cstring>
#include <filesystem>

#include "tests/hostile_files.hpp"

namespace mjarm::hostile {
namespace {

namespace fs = std::filesystem;
using support::TempFolder;

/// MJCF that shows one mesh.
std::string with_mesh(const std::string& file, const std::string& before = "") {
  return mjcf("<geom type=\"mesh\" mesh=\"m\"/>",
              before + "<asset><mesh name=\"m\" file=\"" + file + "\"/></asset>");
}

std::string including(const std::string& file) {
  return "<mujoco>\n<include file=\"" + file + "\"/></mujoco>";
}

template <class Number>
void put(std::string& bytes, Number number) {
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  bytes.append(raw, sizeof number);
}

/// A binary STL that announces `announced` faces and has `faces`, each with the corner `x`.
std::string stl(unsigned announced, int faces, float x = 1) {
  std::string bytes(80, ' ');
  put(bytes, announced);
  for (int i = 0; i < faces; ++i) {
    for (const float value : {0.F, 0.F, 1.F, 0.F, 0.F, 0.F, x, 0.F, 0.F, 0.F, 1.F, 0.F}) {
      put(bytes, value);
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

/// The beginning of a PNG of so many pixels.
std::string png(unsigned width, unsigned height) {
  std::string bytes = "\x89PNG\r\n\x1a\n";
  bytes += std::string("\0\0\0\rIHDR", 8);
  for (const unsigned number : {width, height}) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift);
  }
  bytes += std::string("\x08\x02\0\0\0", 5) + std::string(40, 'x');
  return bytes;
}

std::string whole_numbers(std::initializer_list<int> numbers) {
  std::string bytes;
  for (const int number : numbers) put(bytes, number);
  return bytes;
}

/// What lies outside of the model's folder, which is `in`.
void lay_outside(const TempFolder& folder) {
  folder.write("secret.stl", stl(1, 1));
  folder.write("secret.xml", "<mujoco><worldbody><geom size=\"1\"/></worldbody></mujoco>");
}

void link_to_zero(const TempFolder& folder) {
  fs::create_symlink("/dev/zero", folder.path() / "zero.stl");
  fs::create_symlink("/dev/zero", folder.path() / "zero.xml");
}

void lay_pipe(const TempFolder& folder) {
  mkfifo((folder.path() / "pipe.stl").c_str(), 0600);
  mkfifo((folder.path() / "pipe.xml").c_str(), 0600);
}

const std::vector<std::string> kOutside = {"outside the model's folder", "--allow-outside"};

std::vector<std::string> outside(const std::string& place) {
  std::vector<std::string> words = kOutside;
  words.push_back(place);
  return words;
}

}  // namespace

std::vector<HostileFile> hostile_references() {
  return {
      {"IncludesItself", "a.xml", including("a.xml"), {"a.xml:2: <include>", "itself"}},
      {"IncludesInACircle",
       "a.xml",
       including("b.xml"),
       {".xml", "itself"},
       [](const TempFolder& folder) { folder.write("b.xml", including("a.xml")); }},
      {"IncludeAbsolute", "a.xml", including("/etc/passwd"), outside("a.xml:2: <include>")},
      {"IncludeAbove", "in/a.xml", including("../secret.xml"), outside("a.xml:2: <include>"),
       lay_outside},
      {"IncludeAboveByDetour", "in/a.xml", including("x/../../secret.xml"),
       outside("a.xml:2: <include>"), lay_outside},
      {"IncludeDevice", "a.xml", including("/dev/zero"), outside("a.xml:2: <include>")},
      {"IncludeLinkToDevice",
       "a.xml",
       including("zero.xml"),
       {"zero.xml", "regular file"},
       link_to_zero},
      {"IncludePipe", "a.xml", including("pipe.xml"), {"pipe.xml", "regular file"}, lay_pipe},
      {"IncludeFolder",
       "a.xml",
       including("sub"),
       {"sub", "folder"},
       [](const TempFolder& folder) { fs::create_directory(folder.path() / "sub"); }},
      {"IncludeBinary",
       "a.xml",
       including("b.xml"),
       {"b.xml", "binary"},
       [](const TempFolder& folder) { folder.write("b.xml", std::string(100, '\0')); }},
      {"IncludeTruncated",
       "a.xml",
       including("b.xml"),
       {"b.xml:1", "XML"},
       [](const TempFolder& folder) { folder.write("b.xml", "<mujoco><worldbody>"); }},
      {"IncludesWithoutEnd",
       "a.xml",
       including("b0.xml"),
       {"more than 100 files"},
       [](const TempFolder& folder) {
         for (int i = 0; i < 200; ++i) {
           folder.write("b" + std::to_string(i) + ".xml",
                        including("b" + std::to_string(i + 1) + ".xml"));
         }
       }},
      {"IncludesOfManyBytes",
       "a.xml",
       "<mujoco>" + repeat("<include file=\"b.xml\"/>", 2) + including("c.xml").substr(8),
       {".xml"},
       [](const TempFolder& folder) {
         folder.write("b.xml", "<mujoco>" + std::string(40'000'000, ' ') + "</mujoco>");
         folder.write("c.xml", "<mujoco>" + std::string(40'000'000, ' ') + "</mujoco>");
       }},
      {"MeshAbsolute", "in/a.xml", with_mesh("/etc/passwd"), outside("a.xml:2: <mesh \"m\">")},
      {"MeshAbove", "in/a.xml", with_mesh("../secret.stl"), outside("a.xml:2: <mesh \"m\">"),
       lay_outside},
      {"MeshDevice", "a.xml", with_mesh("/dev/zero"), outside("a.xml:2: <mesh \"m\">")},
      {"MeshLinkToDevice",
       "a.xml",
       with_mesh("zero.stl"),
       {"a.xml:2: <mesh \"m\">", "regular file"},
       link_to_zero},
      {"MeshPipe",
       "a.xml",
       with_mesh("pipe.stl"),
       {"a.xml:2: <mesh \"m\">", "regular file"},
       lay_pipe},
      {"MeshFolderAbove", "in/a.xml", with_mesh("secret.stl", "<compiler meshdir=\"..\"/>"),
       outside("a.xml:2: <mesh \"m\">"), lay_outside},
      {"MeshFolderAbsolute", "in/a.xml", with_mesh("passwd", "<compiler meshdir=\"/etc\"/>"),
       outside("a.xml:2: <mesh \"m\">")},
      {"AssetFolderAbove", "in/a.xml", with_mesh("secret.stl", "<compiler assetdir=\"..\"/>"),
       outside("a.xml:2: <mesh \"m\">"), lay_outside},
      {"MeshFolderOfAnInclude", "in/a.xml", with_mesh("secret.stl", "<include file=\"b.xml\"/>"),
       outside("a.xml:2: <mesh \"m\">"),
       [](const TempFolder& folder) {
         lay_outside(folder);
         folder.write("in/b.xml", "<mujoco><compiler meshdir=\"..\"/></mujoco>");
       }},
      {"TextureAbove", "in/a.xml",
       with_asset("<texture name=\"t\" type=\"2d\" file=\"../secret.png\"/>"),
       outside("a.xml:2: <texture \"t\">")},
      {"TextureSideAbove", "in/a.xml",
       with_asset("<texture name=\"t\" type=\"cube\" fileup=\"../secret.png\"/>"),
       outside("a.xml:2: <texture \"t\">")},
      {"HeightFieldAbove", "in/a.xml",
       with_asset("<hfield name=\"h\" size=\"1 1 1 1\" file=\"../secret.png\"/>"),
       outside("a.xml:2: <hfield \"h\">")},
      {"SkinAbove", "in/a.xml", with_asset("<skin name=\"s\" file=\"../secret.skn\"/>"),
       outside("a.xml:2: <skin \"s\">")},
      {"FlexibleBodyAbove", "in/a.xml",
       mjcf("<flexcomp name=\"f\" type=\"gmsh\" file=\"../secret.msh\"/>"),
       outside("a.xml:3: <flexcomp \"f\">")},
      {"ModelAbove", "in/a.xml", with_asset("<model name=\"m\" file=\"../secret.xml\"/>"),
       outside("a.xml:2: <model \"m\">"), lay_outside},
      {"FaultInASubModel",
       "a.xml",
       with_asset("<model name=\"m\" file=\"b.xml\"/>"),
       {"b.xml:2: <option>", "above 0"},
       [](const TempFolder& folder) {
         folder.write("b.xml", "<mujoco>\n<option timestep=\"-1\"/></mujoco>");
       }},
      {"StlClaimsBillions",
       "a.xml",
       with_mesh("m.stl"),
       {"a.xml:2: <mesh \"m\">", "m.stl", "broken", "has 134"},
       [](const TempFolder& folder) { folder.write("m.stl", stl(4'000'000'000U, 1)); }},
      {"StlClaimsOneMore",
       "a.xml",
       with_mesh("m.stl"),
       {"a.xml:2: <mesh \"m\">", "broken", "284", "234"},
       [](const TempFolder& folder) { folder.write("m.stl", stl(4, 3)); }},
      {"StlEmpty",
       "a.xml",
       with_mesh("m.stl"),
       {"a.xml:2: <mesh \"m\">", "broken"},
       [](const TempFolder& folder) { folder.write("m.stl", ""); }},
      {"StlWithoutFaces",
       "a.xml",
       with_mesh("m.stl"),
       {"a.xml:2: <mesh \"m\">", "no shape"},
       [](const TempFolder& folder) { folder.write("m.stl", stl(0, 0)); }},
      {"StlOfText",
       "a.xml",
       with_mesh("m.stl"),
       {"a.xml:2: <mesh \"m\">", "text form"},
       [](const TempFolder& folder) {
         folder.write("m.stl",
                      "solid m\nfacet normal 0 0 1\nouter loop\n" + repeat("vertex 0 0 0\n", 50));
       }},
      {"StlNan",
       "a.xml",
       with_mesh("m.stl"),
       {"a.xml:2: <mesh \"m\">", "finite"},
       [](const TempFolder& folder) { folder.write("m.stl", stl(4, 4, std::stof("nan"))); }},
      {"ObjIndexOutOfRange",
       "a.xml",
       with_mesh("m.obj"),
       {"a.xml"},
       [](const TempFolder& folder) {
         folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 2000000000\nf 1 2 4\n");
       }},
      {"ObjIndexNegative",
       "a.xml",
       with_mesh("m.obj"),
       {"a.xml"},
       [](const TempFolder& folder) {
         folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -2000000000\n");
       }},
      {"ObjEmpty",
       "a.xml",
       with_mesh("m.obj"),
       {"a.xml"},
       [](const TempFolder& folder) { folder.write("m.obj", ""); }},
      {"MshClaimsBillions",
       "a.xml",
       with_mesh("m.msh"),
       {"a.xml:2: <mesh \"m\">", "broken"},
       [](const TempFolder& folder) {
         folder.write("m.msh", whole_numbers({2'000'000'000, 0, 0, 2'000'000'000, 1, 2, 3}));
       }},
      {"MshNegative",
       "a.xml",
       with_mesh("m.msh"),
       {"a.xml:2: <mesh \"m\">", "broken"},
       [](const TempFolder& folder) { folder.write("m.msh", whole_numbers({-4, 0, 0, -4, 1})); }},
      {"MeshOfUnknownFormat",
       "a.xml",
       with_mesh("m.zip"),
       {"a.xml", "m.zip"},
       [](const TempFolder& folder) { folder.write("m.zip", "PK"); }},
      {"PngOfTenBillionPixels",
       "a.xml",
       with_asset("<texture name=\"t\" type=\"2d\" file=\"t.png\"/>"),
       {"a.xml:2: <texture \"t\">", "t.png", "10000000000"},
       [](const TempFolder& folder) { folder.write("t.png", png(100'000, 100'000)); }},
      {"PngTruncated",
       "a.xml",
       with_asset("<texture name=\"t\" type=\"2d\" file=\"t.png\"/>"),
       {"a.xml", "t.png"},
       [](const TempFolder& folder) { folder.write("t.png", png(64, 64)); }},
      {"HeightFieldFileClaimsBillions",
       "a.xml",
       with_asset("<hfield name=\"h\" size=\"1 1 1 1\" file=\"h.bin\"/>"),
       {"a.xml:2: <hfield \"h\">", "broken"},
       [](const TempFolder& folder) {
         folder.write("h.bin", whole_numbers({2'000'000'000, 2'000'000'000, 0}));
       }},
  };
}

}  // namespace mjarm::hostile
