// Hostile files: URDF.
#include <filesystem>

#include "tests/hostile_files.hpp"

namespace mjarm::hostile {
namespace {

using support::TempFolder;

/// A robot of two links and one hinge; `link` goes into its first link (line 3), `joint` into its
/// joint (line 6), `more` behind (line 7).
std::string urdf(const std::string& link, const std::string& joint = "",
                 const std::string& more = "") {
  return "<robot name=\"r\">\n<link name=\"base\">\n" + link +
         "</link>\n<link name=\"arm\"/>\n<joint name=\"j\" type=\"continuous\"><parent "
         "link=\"base\"/><child link=\"arm\"/>\n" +
         joint + "</joint>\n" + more + "</robot>";
}

std::string showing_mesh(const std::string& file) {
  return urdf("<visual><geometry>\n<mesh filename=\"" + file + "\"/></geometry></visual>");
}

std::string chain(int links) {
  std::string all = "<robot name=\"r\"><link name=\"l0\"/>";
  for (int i = 1; i < links; ++i) {
    const std::string number = std::to_string(i);
    all += "<link name=\"l" + number + "\"/><joint name=\"j" + number +
           "\" type=\"continuous\"><parent link=\"l" + std::to_string(i - 1) +
           "\"/><child link=\"l" + number + "\"/></joint>";
  }
  return all + "</robot>";
}

void lay_secret(const TempFolder& folder) {
  folder.write("secret.stl", std::string(84, ' '));
  folder.write("other/meshes/secret.stl", std::string(84, ' '));
}

}  // namespace

std::vector<HostileFile> hostile_urdf() {
  return {
      {"TwoRoots",
       "a.urdf",
       urdf("", "", "<link name=\"lost\"/>"),
       {"a.urdf:7: <link \"lost\">", "no parent", "base"}},
      {"TwoRobots", "a.urdf", urdf("") + "\n" + urdf(""), {"a.urdf:", "second root"}},
      {"NoLinks", "a.urdf", "<robot name=\"r\"/>", {"a.urdf:1: <robot \"r\">", "<link>"}},
      {"NoJoints",
       "a.urdf",
       "<robot name=\"r\">\n<link name=\"a\"/></robot>",
       {"a.urdf:1: <robot \"r\">", "<joint>"}},
      {"NoJointsBetweenLinks",
       "a.urdf",
       "<robot name=\"r\">\n<link name=\"a\"/>\n<link name=\"b\"/></robot>",
       {"a.urdf:3: <link \"b\">", "no parent"}},
      {"JointToItself",
       "a.urdf",
       urdf("", "",
            "<link name=\"c\"/><joint name=\"k\" type=\"fixed\"><parent link=\"c\"/><child "
            "link=\"c\"/></joint>"),
       {"a.urdf:7: <link \"c\">", "loop"}},
      {"Circle",
       "a.urdf",
       "<robot name=\"r\"><link name=\"a\"/>\n<link name=\"b\"/><joint name=\"i\" type=\"fixed\">"
       "<parent link=\"a\"/><child link=\"b\"/></joint><joint name=\"j\" type=\"fixed\"><parent "
       "link=\"b\"/><child link=\"a\"/></joint></robot>",
       {"a.urdf:1", "loop"}},
      {"HundredThousandLinks",
       "a.urdf",
       +[] { return chain(100'000); },
       {"a.urdf:1: <link \"l1001\">", "1000 joints"}},
      {"TenThousandLinks", "a.urdf", chain(10'000), {"a.urdf:1: <link \"l1001\">", "1000 joints"}},
      {"MisspeltVisual",
       "a.urdf",
       urdf("<visaul><geometry/></visaul>"),
       {"a.urdf:3: <visaul> of \"base\"", "did you mean \"visual\""}},
      {"MisspeltJoint",
       "a.urdf",
       urdf("", "", "<jiont name=\"k\" type=\"fixed\"/>"),
       {"a.urdf:7: <jiont \"k\">", "did you mean \"joint\""}},
      {"MisspeltLimit",
       "a.urdf",
       urdf("", "<limits lower=\"-1\" upper=\"1\"/>"),
       {"a.urdf:6: <limits> of \"j\"", "did you mean \"limit\""}},
      {"MisspeltInertia",
       "a.urdf",
       urdf("<inertial><mass value=\"1\"/><inertai ixx=\"1\"/></inertial>"),
       {"a.urdf:3: <inertai> of \"base\"", "did you mean \"inertia\""}},
      {"MisspeltOrigin",
       "a.urdf",
       urdf("", "<orgin xyz=\"0 0 1\"/>"),
       {"a.urdf:6: <orgin> of \"j\"", "did you mean \"origin\""}},
      {"MisspeltXyz",
       "a.urdf",
       urdf("", "<origin xzy=\"0 0 1\"/>"),
       {"a.urdf:6: <origin> of \"j\"", "\"xzy\"", "did you mean \"xyz\""}},
      {"MisspeltLower",
       "a.urdf",
       urdf("", "<limit lowr=\"-1\"/>"),
       {"a.urdf:6: <limit> of \"j\"", "\"lowr\"", "did you mean \"lower\""}},
      {"MisspeltRadius",
       "a.urdf",
       urdf("<visual><geometry>\n<cylinder raduis=\"1\" length=\"1\"/></geometry></visual>"),
       {"a.urdf:4: <cylinder> of \"base\"", "did you mean \"radius\""}},
      {"MisspeltShape",
       "a.urdf",
       urdf("<visual><geometry>\n<shpere radius=\"1\"/></geometry></visual>"),
       {"a.urdf:4: <shpere> of \"base\"", "did you mean \"sphere\""}},
      {"NoShape",
       "a.urdf",
       urdf("<visual>\n<geometry/></visual>"),
       {"a.urdf:4: <geometry> of \"base\"", "<mesh>"}},
      {"OriginNan",
       "a.urdf",
       urdf("", "<origin xyz=\"0 nan 0\"/>"),
       {"a.urdf:6: <origin> of \"j\"", "\"xyz\"", "finite"}},
      {"OriginInfinite",
       "a.urdf",
       urdf("", "<origin rpy=\"0 inf 0\"/>"),
       {"a.urdf:6: <origin> of \"j\"", "\"rpy\"", "finite"}},
      {"OriginFarAway",
       "a.urdf",
       urdf("", "<origin xyz=\"0 1e300 0\"/>"),
       {"a.urdf:6: <origin> of \"j\"", "1e300", "too large"}},
      {"BoxHuge",
       "a.urdf",
       urdf("<collision><geometry>\n<box size=\"1e308 1 1\"/></geometry></collision>"),
       {"a.urdf:4: <box> of \"base\"", "1e308"}},
      {"BoxNan",
       "a.urdf",
       urdf("<collision><geometry>\n<box size=\"nan 1 1\"/></geometry></collision>"),
       {"a.urdf:4: <box> of \"base\"", "finite"}},
      {"SphereNegative",
       "a.urdf",
       urdf("<collision><geometry>\n<sphere radius=\"-1\"/></geometry></collision>"),
       {"a.urdf"}},
      {"MassHuge",
       "a.urdf",
       urdf("<inertial><mass value=\"1e300\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/></inertial>"),
       {"a.urdf:3: <mass> of \"base\"", "1e300"}},
      {"InertiaHuge",
       "a.urdf",
       urdf("<inertial><mass value=\"1\"/><inertia ixx=\"1e300\" iyy=\"1\" izz=\"1\"/></inertial>"),
       {"a.urdf:3: <inertia> of \"base\"", "1e300"}},
      {"LimitInfinite",
       "a.urdf",
       urdf("", "<limit lower=\"-inf\" upper=\"inf\"/>"),
       {"a.urdf:6: <limit> of \"j\"", "finite"}},
      {"AxisNan",
       "a.urdf",
       urdf("", "<axis xyz=\"nan nan nan\"/>"),
       {"a.urdf:6: <axis> of \"j\"", "finite"}},
      {"MeshAbsolute",
       "in/a.urdf",
       showing_mesh("/usr/secret.stl"),
       {"a.urdf:4: <mesh> of \"base\""}},
      {"MeshAbove",
       "in/a.urdf",
       showing_mesh("../secret.stl"),
       {"a.urdf:4: <mesh> of \"base\"", "outside the model's folder", "--allow-outside"},
       lay_secret},
      {"MeshAboveItsPackage",
       "in/a.urdf",
       showing_mesh("package://in/../secret.stl"),
       {"a.urdf:4: <mesh> of \"base\"", "outside the model's folder"},
       lay_secret},
      {"MeshOfNoPackage",
       "in/a.urdf",
       showing_mesh("package://other/meshes/secret.stl"),
       {"a.urdf:4: <mesh> of \"base\"", "outside the model's folder"},
       lay_secret},
      {"MeshByUrlAbove",
       "in/a.urdf",
       showing_mesh("file://../secret.stl"),
       {"a.urdf:4: <mesh> of \"base\"", "outside the model's folder"},
       lay_secret},
      {"MeshDevice", "a.urdf", showing_mesh("/dev/zero.stl"), {"a.urdf:4: <mesh> of \"base\""}},
      {"MeshLies",
       "a.urdf",
       showing_mesh("m.stl"),
       {"a.urdf:4: <mesh> of \"base\"", "broken"},
       [](const TempFolder& folder) { folder.write("m.stl", std::string(90, '\x7f')); }},
      {"Xacro",
       "a.urdf",
       "<robot name=\"r\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\">\n<xacro:include "
       "filename=\"x.xacro\"/></robot>",
       {"a.urdf:2: <xacro:include>", "xacro a.urdf"}},
      {"Doctype", "a.urdf", "<!DOCTYPE robot [<!ENTITY x \"y\">\n]>\n" + urdf(""), {"a.urdf:"}},
      {"Latin1Link",
       "a.urdf",
       urdf("", "",
            "<link name=\"H\xfc"
            "fte\"/>"),
       {"a.urdf:7: <link", "UTF-8"}},
      {"LinkTwice",
       "a.urdf",
       urdf("", "", "<link name=\"arm\"/>"),
       {"a.urdf:7: <link \"arm\">", "twice"}},
      {"NegativeMass",
       "a.urdf",
       urdf("<inertial><mass value=\"-1\"/></inertial>"),
       {"a.urdf:3: <mass> of \"base\"", "negative"}},
      {"NestedDeep",
       "a.urdf",
       urdf(repeat("<x>", 50'000) + repeat("</x>", 50'000)),
       {"nested too deep"}},
      {"Truncated", "a.urdf", urdf("").substr(0, 60), {"a.urdf:", "XML"}},
  };
}

}  // namespace mjarm::hostile
