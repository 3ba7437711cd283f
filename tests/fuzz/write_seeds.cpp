// Usage: write_seeds FOLDER. Writes what the fuzzer starts from: the hostile files, and small good
// ones for what they reach.
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mjarm/core/file.hpp"
#include "tests/hostile_files.hpp"

namespace {

constexpr std::size_t kLongest = 20'000;  ///< long inputs are slow, and teach nothing new

/// MJCF that uses many kinds of elements at once.
constexpr const char* kGarden = R"(<mujoco><option timestep="0.002"/><default><geom density="500"/>
<default class="d"><joint damping="1"/></default></default><asset>
<texture name="t" type="2d" builtin="checker" width="8" height="8"/><material name="m" texture="t"/>
<hfield name="h" nrow="4" ncol="4" size="1 1 1 .1"/><mesh name="k" builtin="sphere" params="1"/>
<mesh name="v" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/></asset><worldbody><light pos="0 0 3"/>
<geom type="hfield" hfield="h"/><frame pos="0 0 1"><replicate count="3" offset="1 0 0"><body>
<freejoint/><geom type="capsule" size=".1 .2" material="m"/></body></replicate></frame>
<body name="a"><joint name="j" class="d" range="-90 90"/><geom name="g" type="mesh" mesh="v"/>
<site name="s"/><camera name="c" mode="trackcom"/><body name="b"><joint name="l" type="slide"/>
<geom type="box" size=".1 .1 .1"/><site name="e"/><body name="u"><joint type="ball"/>
<geom size=".1"/></body></body></body><flexcomp name="f" type="grid" dim="2" count="3 3 1"
spacing=".1 .1 .1" radius=".01" mass="1"><edge equality="true"/></flexcomp></worldbody>
<contact><exclude body1="a" body2="b"/></contact><tendon><spatial name="w"><site site="s"/>
<site site="e"/></spatial><fixed name="x"><joint joint="j" coef="1"/></fixed></tendon><equality>
<connect body1="a" body2="b" anchor="0 0 0"/><joint joint1="j" joint2="l"/></equality><actuator>
<motor joint="j" ctrllimited="true" ctrlrange="-1 1"/><position tendon="w" kp="5"/>
<muscle joint="j"/></actuator><sensor><jointpos joint="j"/><framepos objtype="site" objname="s"/>
<rangefinder site="s"/></sensor><keyframe><key qpos="0 0 0"/></keyframe></mujoco>)";

constexpr const char* kRobot =
    R"(<robot name="r"><material name="m"><color rgba="1 0 0 1"/></material>
<link name="a"><visual><origin xyz="0 0 1" rpy="0 1 0"/><geometry><box size="1 1 1"/></geometry>
<material name="m"/></visual></link><link name="b"><inertial><mass value="1"/><inertia ixx="1"
iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial><collision><geometry><cylinder radius="1"
length="2"/></geometry></collision></link><link name="c"/><joint name="i" type="revolute"><parent
link="a"/><child link="b"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" velocity="1" effort="5"/>
<dynamics damping="1" friction="1"/></joint><joint name="j" type="prismatic"><parent link="b"/><child
link="c"/><limit lower="-1" upper="1"/><mimic joint="i" multiplier="2"/></joint></robot>)";

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  const std::string folder = std::string(arguments[1]) + "/";
  std::vector<std::pair<std::string, std::string>> seeds = {
      {"garden", kGarden},
      {"robot", kRobot},
      {"stl", "stl\n" + std::string(80, ' ') + std::string("\1\0\0\0", 4) + std::string(50, '\1')},
      {"obj", "obj\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n"},
      {"bin", "bin\n" + std::string("\2\0\0\0\2\0\0\0", 8) + std::string(16, '\0')}};
  for (const auto& files : {mjarm::hostile::hostile_texts(), mjarm::hostile::hostile_mjcf(),
                            mjarm::hostile::hostile_references(), mjarm::hostile::hostile_urdf()}) {
    for (const auto& file : files) {
      // Those that are stopped for their time alone would stop the fuzzer as well.
      const bool slow = file.label == "FlexibleBodyLarge" || file.label == "ManyLargeTextures";
      std::string text = file.content.text();
      if (!slow && text.size() < kLongest) {
        seeds.emplace_back(file.label + file.file[0], std::move(text));
      }
    }
  }
  for (const auto& [name, content] : seeds) {
    if (const auto done = mjarm::write_file(folder + name, content); !done) {
      std::fprintf(stderr, "%s\n", done.error().what.c_str());
      return 1;
    }
  }
  return 0;
}
