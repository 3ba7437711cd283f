#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "mjarm/model/check.hpp"
#include "tests/robots.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/test_data.hpp"

/// One fault at a time is planted into a good model; `check_model` must name it: right code, grade,
/// element, file and line.
namespace mjarm::planted {

namespace fs = std::filesystem;
constexpr const char* kUr5e = "universal_robots_ur5e/ur5e.xml";
constexpr const char* kScene = "universal_robots_ur5e/scene.xml";
constexpr const char* kUrdf = "universal_robots_ur5e/ur5e.urdf";
constexpr const char* kSmall = "small.xml";
constexpr Grade kError = Grade::error;
constexpr Grade kWarning = Grade::warning;
constexpr Grade kNote = Grade::note;

/// A small arm with a finger, its angles in degrees; for what ours cannot show.
constexpr const char* kSmallArm = R"(<mujoco model="small">
  <compiler angle="degree"/>
  <option integrator="implicitfast"/>
  <worldbody>
    <body name="base">
      <geom type="box" size="0.05 0.05 0.05" pos="0 0 -0.1"/>
      <body name="one" euler="0 0 90">
        <joint name="turn" axis="0 0 1" range="-170 170"/>
        <geom type="capsule" fromto="0 0 0.02 0 0 0.2" size="0.02"/>
        <body name="two" pos="0 0 0.25">
          <joint name="lift" axis="0 1 0" range="-120 120"/>
          <geom type="capsule" fromto="0 0 0.03 0 0 0.2" size="0.02"/>
          <body name="three" pos="0 0 0.25">
            <joint name="bend" axis="0 1 0" range="-120 120"/>
            <geom type="capsule" fromto="0 0 0.03 0 0 0.1" size="0.015"/>
            <site name="tcp" pos="0 0 0.15"/>
            <body name="left" pos="0 0.03 0.13">
              <joint name="left_finger" type="slide" axis="0 1 0" range="0 0.02"/>
              <geom type="box" size="0.005 0.005 0.02"/>
            </body>
          </body>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator>
    <position name="turn" joint="turn" kp="300" kv="20" ctrlrange="-3 3" forcerange="-50 50"/>
    <position name="lift" joint="lift" kp="300" kv="20" ctrlrange="-2.1 2.1" forcerange="-50 50"/>
    <position name="bend" joint="bend" kp="300" kv="20" ctrlrange="-2.1 2.1" forcerange="-50 50"/>
    <position name="grip" joint="left_finger" kp="100" kv="5" ctrlrange="0 0.02" forcerange="-9 9"/>
  </actuator>
  <keyframe>
    <key name="home" qpos="0 0.4 0.8 0.01" ctrl="0 0.4 0.8 0.01"/>
  </keyframe>
</mujoco>
)";

/// Replaces the first `from` behind the first `behind` (may be empty) by `to`.
struct Edit {
  std::string behind, from, to;
};

/// A fault and what must be said about it.
struct Fault {
  const char* name;    ///< of the test
  const char* main;    ///< file that is checked
  const char* edited;  ///< file that is changed
  std::vector<Edit> edits;
  CheckCode code;
  Grade grade;
  const char* element;  ///< what the finding names; null = any
  /// Text in the edited file whose line is meant; null = the element that the last edit changes.
  const char* line_of = nullptr;

  friend void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }
};

inline int line_at(const std::string& text, std::size_t at) {
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<long>(at), '\n'));
}

/// Where the element begins that holds position `at`.
inline std::size_t edit_start(const std::string& text, std::size_t at) {
  return text.rfind('<', at);
}

/// The models folder in a place where it may be changed, the UR5e in one file.
inline void copy_models(const support::TempFolder& folder) {
  fs::copy(testing::models_folder(), folder.path(), fs::copy_options::recursive);
  folder.write(kUr5e, support::read_mjcf(testing::models_folder() / kUr5e));
  folder.write("small.xml", kSmallArm);
}

inline std::string all_of(const CheckReport& report) {
  std::string all;
  for (const Finding& f : report.findings) {
    all += std::string(name(f.grade)) + " " + std::string(name(f.code)) + " " +
           fs::path(f.file).filename().string() + ":" + std::to_string(f.line) + " " + f.element +
           " " + f.what + "\n";
  }
  return all;
}

/// Writes the models with the fault into `folder`. @return where in the edited file, npos for an
/// edit that does not fit.
inline std::size_t plant(const support::TempFolder& folder, const Fault& fault, std::string& text) {
  copy_models(folder);
  text = folder.read(fault.edited);
  std::size_t at = 0;
  for (const Edit& edit : fault.edits) {
    const std::size_t behind = text.find(edit.behind);
    at = behind == std::string::npos ? behind : text.find(edit.from, behind);
    if (at == std::string::npos) return at;
    text.replace(at, edit.from.size(), edit.to);
  }
  folder.write(fault.edited, text);
  return at;
}

/// Plants the fault and checks what is said about it.
inline void expect_named(const Fault& fault) {
  const support::TempFolder folder;
  std::string text;
  const std::size_t at = plant(folder, fault, text);
  ASSERT_NE(at, std::string::npos) << "an edit does not fit " << fault.edited;
  std::size_t meant = edit_start(text, at);
  if (fault.line_of != nullptr) meant = text.find(fault.line_of);
  ASSERT_NE(meant, std::string::npos);

  CheckOptions options;
  options.load.allow_outside = true;  // scenes lie beside the folders of the arms
  const auto report = check_model(folder.path() / fault.main, options);
  ASSERT_TRUE(report) << report.error().what;
  bool found = false;
  for (const Finding& f : report->findings) {
    found |= f.code == fault.code && f.grade == fault.grade &&
             (fault.element == nullptr || f.element == fault.element) &&
             fs::path(f.file).filename() == fs::path(fault.edited).filename() &&
             f.line == line_at(text, meant) && !f.what.empty();
  }
  EXPECT_TRUE(found) << name(fault.grade) << " " << name(fault.code) << " expected at line "
                     << line_at(text, meant) << "; found:\n"
                     << all_of(*report);
}

}  // namespace mjarm::planted
